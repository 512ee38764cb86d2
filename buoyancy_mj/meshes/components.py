"""Connected components of graphs, such as pieces of a surface or bodies that move as one."""

import numpy as np
import scipy
from numpy.typing import NDArray


def label_components(edges: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Number the connected components of a graph.

    Args:
        edges: nodes at the ends of each edge (m, 2).
        count: number of nodes.

    Returns:
        For each node (count,) the number of its component, from 0 in the order of first nodes.
    """
    one, other = np.asarray(edges, np.int64).reshape(-1, 2).T
    graph = scipy.sparse.coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    _, labels = scipy.sparse.csgraph.connected_components(graph, directed=False)
    return np.asarray(labels, np.int64)
