"""`RecordingFile`: a file that grows while a run goes on, and tells its user what kept it."""

from pathlib import Path

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.files import GrowingFile


class RecordingFile(GrowingFile):
    """A `GrowingFile` whose errors say what helps.

    Args:
        path: the file; its folder is made.
        choice: how its user chooses another place, as '(--record)'.
        grows_as: the end of the name under which it grows, as '.csv'; '' for that of its own.

    Raises:
        RecordingError: another run is writing it, or it cannot be made.
    """

    def __init__(self, path: Path, choice: str, grows_as: str = "") -> None:
        try:
            super().__init__(path, grows_as)
        except BlockingIOError as error:
            raise RecordingError(
                f"another run is writing '{error.filename}'; choose another place {choice}"
            ) from error
        except OSError as error:
            raise RecordingError(
                f"cannot write '{path}': {error.strerror}; choose another place {choice}"
            ) from error

    def take_name(self, *, complete: bool) -> Path:
        """Give the closed file its name, as `GrowingFile` does.

        Raises:
            RecordingError: it cannot take its name.
        """
        try:
            return super().take_name(complete=complete)
        except OSError as error:
            raise RecordingError(
                f"cannot write '{self.path}': {error.strerror}; what was written is in "
                f"'{self.partial}'"
            ) from error
