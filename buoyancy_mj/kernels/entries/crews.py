"""Threads that help to do one job: the items of a load, hulls or bodies, in pieces.

The job's next piece and the number of its pieces stand in one word. Whoever adds one to the former
at one go with all threads, and finds it below the latter, has that piece to do. So a helper that
comes late, or never, holds nobody up: the caller does what nobody took, and waits for pieces that
are being done alone. What the job is does not change before all its pieces are done.

Each item writes to rows of its own, by the same code and from the same numbers, whoever does it. So
the results have the same bits for any number of threads.
"""

from typing import Annotated, NamedTuple

from numba import int64, void

from buoyancy_mj.kernels.arrays import Words
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.entries.pointers import add_to_word, call, exchange, word
from buoyancy_mj.kernels.entries.tables import WaterTable, Workplace
from buoyancy_mj.kernels.entries.views import view

MOST = 63
"""Helpers at most."""
PIECES = 8
"""Pieces of a job for each thread: threads that are late, or busy with others, do fewer."""
NEXT = 1 << 32
"""One piece further, in `Crew.turn`; the bits below count the pieces."""
FUNCTION, MODEL, DATA, RECORD, WATER, ITEMS, SIZE, JOB = range(8)
"""Columns of `Crew.job`, and how many: the C function that does a piece, the first four words that
it takes, the number of items, and that of a piece."""
CREW, INDEX, POST = range(3)
"""Words of what a helper is told, and how many: address of the table of the crew, and its index."""


class Crew(NamedTuple):
    """Threads that help one caller at a time; they sleep on locks of Python's, without Python."""

    turn: int
    """Address of a word: the next piece of the job, times `NEXT`, and the number of its pieces."""
    done: int
    """Address of a word: how many of its pieces are done."""
    taken: int
    """Address of a word that is 1 while the crew helps somebody."""
    asleep: int
    """Address of `MOST` words that are 1 while a helper sleeps, or is about to."""
    posts: int
    """Address of what each helper is told, `POST` words each."""
    hired: Annotated[Words, (1,)]
    """How many helpers there are."""
    job: Annotated[Words, (JOB,)]
    """What is to be done, in columns `FUNCTION` to `SIZE`."""
    locks: Annotated[Words, (MOST + 1,)]
    """Locks, held all the time, that wake a helper when they are released; the last one wakes the
    caller."""
    work: int
    """The C function `work`."""
    start: int
    """Python's PyThread_start_new_thread."""
    acquire: int
    """Python's PyThread_acquire_lock."""
    release: int
    """Python's PyThread_release_lock."""


@njit(cache=True, error_model="numpy")
def share(function, words, items, links):
    """Call a C function of five words, a first item and one past the last, on all items.

    The words are the addresses of mjModel, mjData, a record, a water and the caller's workplace.
    Threads share the items if the water has several and nobody else has the crew. Returns what the
    function does where the caller does all; else 0.
    """
    model, data, record, water, place = words
    size = max((items + PIECES * links.threads - 1) // (PIECES * links.threads), 1)
    pieces = (items + size - 1) // size
    if links.crew == 0 or pieces < 2:
        return call(function, (model, data, record, water, place, int64(0), items))
    crew = view(links.crew, Crew)
    if exchange(crew.taken, 1) != 0:
        return call(function, (model, data, record, water, place, int64(0), items))

    # tell what the job is, open it, and wake helpers
    _hire(crew, links.threads - 1)
    job = crew.job
    job[FUNCTION], job[MODEL], job[DATA], job[RECORD] = function, model, data, record
    job[WATER], job[ITEMS], job[SIZE] = water, items, size
    exchange(crew.done, 0)
    exchange(crew.turn, pieces)
    for i in range(min(links.threads - 1, crew.hired[0], pieces - 1)):
        if exchange(crew.asleep + 8 * i, 0) != 0:
            call(crew.release, (crew.locks[i],))

    # help, and wait for what others are doing
    if not _take_turns(crew, place):
        call(crew.acquire, (crew.locks[MOST], int64(1)))
    exchange(crew.taken, 0)
    return 0


@njit(cache=True, error_model="numpy")
def _hire(crew, wanted):
    """Start threads until there are as many helpers as wanted, or no thread can be started."""
    hired = crew.hired
    while hired[0] < min(wanted, MOST):
        i = hired[0]
        hired[0] = i + 1
        exchange(crew.asleep + 8 * i, 0)
        if call(crew.start, (crew.work, crew.posts + 8 * POST * i)) == -1:
            hired[0] = i
            return


@njit(cache=True, error_model="numpy")
def _take_turns(crew, place):
    """Do pieces of the job until all are taken.

    A helper has no `place` of its own, which is 0 then. Returns whether the piece that was done
    last of all was done here.
    """
    job = crew.job
    was_last = False
    while True:
        taken = add_to_word(crew.turn, NEXT)
        piece, pieces = taken // NEXT, taken % NEXT
        if piece >= pieces:
            return was_last
        water, first = job[WATER], piece * job[SIZE]
        last = min(first + job[SIZE], job[ITEMS])
        at = place if place != 0 else take_workplace(water)
        call(job[FUNCTION], (job[MODEL], job[DATA], job[RECORD], water, at, first, last))
        if place == 0:
            exchange(view(at, Workplace).taken, 0)
        # from here on the water may be gone
        was_last = add_to_word(crew.done, 1) == pieces - 1


@njit(cache=True, error_model="numpy")
def take_workplace(water):
    """Address of a workplace that no other thread works at, from the pool of the water."""
    pool = view(water, WaterTable).pool
    i = 0
    while exchange(view(pool[i], Workplace).taken, 1) != 0:
        i = (i + 1) % pool.shape[0]
    return pool[i]


def work(post: int64) -> void:
    """What a helper does: the pieces of jobs, and sleep in between."""
    crew, i = view(word(post + 8 * CREW), Crew), word(post + 8 * INDEX)
    asleep = crew.asleep + 8 * i
    while crew.hired[0] > i:
        if _take_turns(crew, int64(0)):
            call(crew.release, (crew.locks[MOST],))
        exchange(asleep, 1)
        # a job may have come before the caller could see that
        taken = add_to_word(crew.turn, 0)
        if taken // NEXT < taken % NEXT and exchange(asleep, 0) != 0:
            continue
        call(crew.acquire, (crew.locks[i], int64(1)))
