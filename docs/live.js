// pictures of recordings: a button puts the viewer in the place of the picture
if (location.protocol.startsWith("http")) {
  for (const button of document.querySelectorAll("button[data-viewer]")) {
    const place = button.parentElement;
    button.hidden = false;
    button.addEventListener("click", () => {
      const frame = document.createElement("iframe");
      frame.src = button.dataset.viewer;
      frame.title = place.querySelector("img").alt;
      const alone = document.createElement("a");
      alone.href = button.dataset.viewer;
      alone.target = "_blank";
      alone.textContent = "Open it in a window of its own";
      place.classList.add("open");
      place.replaceChildren(frame);
      place.after(alone);
    });
  }
}
