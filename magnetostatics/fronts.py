"""In which order and in which dense blocks a sparse symmetric matrix is factorised: what its pattern alone decides.

Neighbouring columns of the factor whose entries lie in nearly the same rows make a front: a panel of these columns, the
pivots, and an update matrix of the rows below, which is added to the front of the parent in the elimination tree.
Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM TOMS 9 (1983); Liu, The
role of elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11 (1990).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from compiling import compiled


class Fronts(NamedTuple):
    """Of s fronts, every one after its children; unknowns bear their places in the elimination.

    columns: index of the first pivot of every front, then the number of unknowns (s + 1,)
    row_starts: index where the rows of a front begin (s + 1,); rows: indices of its pivots, then of the rows below (r,)
    relative: index of a row below the pivots among the rows of the parent (r,)
    parent: index of that of every front, -1 for none (s,)
    child: index of the first child, -1 for none (s,); sibling: index of the next child of the same parent (s,)
    panels: index where the panel of a front begins in the factor, column by column (s + 1,)
    updates: index where its update matrix begins in the workspace (s,)
    entry_starts: index where the entries of the matrix in the pivots of a front begin (s + 1,)
    entry_sources: indices of these in the given pattern (k,); entry_places: indices in the panel (k,)
    """

    columns: np.ndarray
    row_starts: np.ndarray
    rows: np.ndarray
    relative: np.ndarray
    parent: np.ndarray
    child: np.ndarray
    sibling: np.ndarray
    panels: np.ndarray
    updates: np.ndarray
    entry_starts: np.ndarray
    entry_sources: np.ndarray
    entry_places: np.ndarray


def analysed(rows: np.ndarray, columns: np.ndarray, order: np.ndarray) -> tuple[Fronts, np.ndarray, np.ndarray, int]:
    """Fronts, the order of elimination that they count in, the entries of every column of the factor, the workspace.

    analysed: indices, indices (n,), number of entries (n,), number of values; rows, columns: indices of the entries of
    one triangle (k,); order: that fill is small in, indices (n,)
    """
    order, parent, counts = _with_tree(rows, columns, order)
    starts = np.append(0, np.flatnonzero(_amalgamated(parent, counts)) + 1)
    pivots, below = np.diff(starts), counts[starts[1:] - 1] - 1
    front = np.append(np.repeat(np.arange(len(pivots)), pivots), -1)  # of every column
    up = front[parent[starts[1:] - 1]]
    updates, workspace = _update_places(up, below)
    panels = _cumulated(pivots * (pivots + below))
    indexed = _indexed(_ordered(rows, columns, _inverse(order)), starts, _cumulated(pivots + below), _families(up))
    return Fronts(columns=starts, parent=up, panels=panels, updates=updates, **indexed), order, counts, workspace


def _with_tree(rows: np.ndarray, columns: np.ndarray, order: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The order with descendants next to each other, and parents and counts of entries in it, (n,) each."""
    smaller, larger = _ordered(rows, columns, _inverse(order))
    of_row = _bucketed(larger, len(order))
    parent = _elimination_tree(of_row, smaller)
    post = _postorder(parent)
    counts = _column_counts(_bucketed(smaller, len(order)), larger, parent, post)
    return order[post], np.append(_inverse(post), -1)[parent[post]], counts[post]


def _indexed(
    pairs: tuple[np.ndarray, np.ndarray],
    starts: np.ndarray,
    row_starts: np.ndarray,
    families: tuple[np.ndarray, np.ndarray],
) -> dict[str, np.ndarray]:
    """What of ``Fronts`` follows from its columns and rows; pairs: (column, row) of the entries of the lower triangle.

    families: (child, sibling), indices (s,) each
    """
    entries = _bucketed(pairs[0], int(starts[-1]))
    rows = _rising(_structure(starts, row_starts, entries, pairs[1], *families), row_starts, int(starts[-1]))
    return {
        "row_starts": row_starts,
        "rows": rows,
        "relative": _relative_places(starts, row_starts, rows, *families),
        "child": families[0],
        "sibling": families[1],
        "entry_starts": entries[0][starts],
        "entry_sources": entries[1].astype(np.uint32),
        "entry_places": _entry_places(starts, row_starts, rows, entries, pairs[1]).astype(np.uint32),
    }


def _ordered(rows: np.ndarray, columns: np.ndarray, number: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Smaller and larger new number of the entries, indices (k,) each; number: of every unknown, index (n,)."""
    first, second = number[rows], number[columns]
    return np.minimum(first, second), np.maximum(first, second)


def _inverse(order: np.ndarray) -> np.ndarray:
    """Place of every index in an order; both indices (n,)."""
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return place


def _cumulated(counts: np.ndarray) -> np.ndarray:
    """Where each of several stretches begins, then the end: indices (s + 1,); counts: number of places of each (s,)."""
    return np.concatenate([[0], np.cumsum(counts)])


def _bucketed(keys: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """(starts, order): indices (size + 1,) and (k,) of the entries by key, those of equal keys in their old order.

    keys: indices (k,), below size
    """
    starts = _cumulated(np.bincount(keys, minlength=size))
    return starts, _distributed(keys, starts[:-1].copy())


@compiled
def _distributed(keys: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Indices (k,) of the entries by key, indices (k,); free: where the next entry of every key goes, indices (n,)."""
    order = np.empty(len(keys), np.int64)
    for entry in range(len(keys)):
        order[free[keys[entry]]] = entry
        free[keys[entry]] += 1
    return order


@compiled
def _elimination_tree(of_row: tuple[np.ndarray, np.ndarray], smaller: np.ndarray) -> np.ndarray:
    """Parent of every unknown: that of the first entry below the diagonal of its column in the factor (n,), an index.

    of_row: entries by the larger of their indices; smaller: the other one, indices (k,). Liu (1990), algorithm 4.2.
    """
    starts, order = of_row
    parent, ancestor = np.full(len(starts) - 1, -1), np.full(len(starts) - 1, -1)
    for j in range(len(parent)):
        for entry in order[starts[j] : starts[j + 1]]:
            i = smaller[entry]
            while i != -1 and i < j:
                following = ancestor[i]
                ancestor[i] = j
                if following == -1:
                    parent[i] = j
                i = following
    return parent


@compiled
def _column_counts(
    of_column: tuple[np.ndarray, np.ndarray], larger: np.ndarray, parent: np.ndarray, post: np.ndarray
) -> np.ndarray:
    """Number of entries in every column of the factor, its diagonal among them (n,).

    Row i of the factor is the part of the elimination tree between i and the columns of its entries. Only the leaves
    of these parts and where their ways up meet are counted: Gilbert, Ng and Peyton, An efficient algorithm to compute
    row and column counts for sparse Cholesky factorization, SIAM J. Matrix Anal. Appl. 15 (1994).
    of_column: entries by the smaller of their indices; larger: the other one, indices (k,)
    parent: index, -1 for none (n,); post: order in which every node follows its descendants at once, indices (n,)
    """
    starts, order = of_column
    first = _first_descendants(parent, post)
    counts = np.zeros(len(parent), np.int64)
    last_first, last_leaf, ancestor = np.full(len(parent), -1), np.full(len(parent), -1), np.arange(len(parent))
    for k in range(len(post)):
        j = post[k]
        if first[j] == k:
            counts[j] += 1
        if parent[j] >= 0:
            counts[parent[j]] -= 1
        for entry in order[starts[j] : starts[j + 1]]:
            i = larger[entry]
            if i == j or first[j] <= last_first[i]:
                continue
            last_first[i] = first[j]
            counts[j] += 1
            if last_leaf[i] >= 0:
                counts[_root(last_leaf[i], ancestor)] -= 1
            last_leaf[i] = j
        if parent[j] >= 0:
            ancestor[j] = parent[j]
    for j in post:
        if parent[j] >= 0:
            counts[parent[j]] += counts[j]
    return counts


@compiled
def _first_descendants(parent: np.ndarray, post: np.ndarray) -> np.ndarray:
    """Place in the postorder of the first descendant of every node, indices (n,); arguments as of the counts (n,)."""
    first = np.full(len(parent), -1)
    for k in range(len(post)):
        node = post[k]
        while node != -1 and first[node] == -1:
            first[node] = k
            node = parent[node]
    return first


@compiled
def _root(node: int, ancestor: np.ndarray) -> int:
    """Root of the part of a tree that a node is in, an index; the ways up, indices (n,), become shorter by it."""
    root = node
    while root != ancestor[root]:
        root = ancestor[root]
    while node != root:
        node, ancestor[node] = ancestor[node], root
    return root


@compiled
def _families(parent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First child and next sibling of every node, -1 for none, indices (n,) each; parent: index, -1 for none (n,)."""
    child, sibling = np.full(len(parent), -1), np.full(len(parent), -1)
    for node in range(len(parent) - 1, -1, -1):
        if parent[node] >= 0:
            sibling[node] = child[parent[node]]
            child[parent[node]] = node
    return child, sibling


@compiled
def _postorder(parent: np.ndarray) -> np.ndarray:
    """Order in which every node follows its descendants at once, indices (n,); parent: index, -1 for none (n,)."""
    child, sibling = _families(parent)
    order, found = np.empty(len(parent), np.int64), 0
    for root in range(len(parent)):
        node = root if parent[root] < 0 else -1
        while node != -1:
            while child[node] != -1:  # down to the first leaf that is left
                first = child[node]
                child[node] = sibling[first]
                node = first
            order[found] = node
            found += 1
            node = parent[node]
    return order


@compiled
def _amalgamated(parent: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Whether a front ends with a column, (n,).

    A column joins the front that ends before it when it is the parent of its last column and few zeros come of it.
    parent: index, -1 for none (n,); counts: number of entries of every column (n,)
    """
    first, zeros = np.zeros(len(parent), np.int64), np.zeros(len(parent), np.int64)
    is_end = np.ones(len(parent), np.bool_)
    for last in range(len(parent)):
        first[last] = last
        while first[last] > 0:
            end = first[last] - 1
            if not 0 <= parent[end] <= last:
                break
            width = last + 1 - first[end]
            height = last - end + counts[last] - 1
            more = zeros[end] + zeros[last] + (first[last] - first[end]) * (height - counts[end] + 1)
            if not _is_worth(width, more / (width * (width + 1) / 2 + width * (counts[last] - 1))):
                break
            is_end[end], zeros[last], first[last] = False, more, first[end]
    return is_end


@compiled
def _is_worth(width: int, zeros: float) -> bool:
    """Whether a front of some columns (width, their number) may hold a share of zeros, dimensionless.

    The bounds of CHOLMOD (Chen, Davis, Hager and Rajamanickam, ACM TOMS 35 (2008), algorithm 887).
    """
    return width <= 4 or (width <= 16 and zeros < 0.8) or (width <= 48 and zeros < 0.1) or zeros < 0.05


@compiled
def _structure(
    starts: np.ndarray,
    row_starts: np.ndarray,
    entries: tuple[np.ndarray, np.ndarray],
    lower: np.ndarray,
    child: np.ndarray,
    sibling: np.ndarray,
) -> np.ndarray:
    """Rows of every front in any order (r,): of the matrix in its columns, and those that its children leave.

    starts, row_starts, child, sibling: as in ``Fronts``; entries: by their columns; lower: their rows, indices (k,)
    """
    rows, seen = np.empty(row_starts[-1], np.int64), np.full(starts[-1], -1)
    for s in range(len(child)):
        found = row_starts[s]
        for column in range(starts[s], starts[s + 1]):
            found = _noted(column, s, seen, rows, found)
        for k in range(entries[0][starts[s]], entries[0][starts[s + 1]]):
            found = _noted(lower[entries[1][k]], s, seen, rows, found)
        c = child[s]
        while c != -1:
            for k in range(row_starts[c], row_starts[c + 1]):
                if rows[k] >= starts[c + 1]:
                    found = _noted(rows[k], s, seen, rows, found)
            c = sibling[c]
    return rows


@compiled
def _noted(row: int, front: int, seen: np.ndarray, rows: np.ndarray, found: int) -> int:
    """Number of rows found, with this one if the front had not seen it; seen, rows: indices (n,) and (r,)."""
    if seen[row] == front:
        return found
    seen[row] = front
    rows[found] = row
    return found + 1


@compiled
def _rising(rows: np.ndarray, row_starts: np.ndarray, size: int) -> np.ndarray:
    """The rows of every front by rising index, (r,); rows, row_starts: indices (r,) below size and (s + 1,)."""
    front, free = np.empty(len(rows), np.int64), np.zeros(size + 1, np.int64)
    for s in range(len(row_starts) - 1):
        for k in range(row_starts[s], row_starts[s + 1]):
            front[k] = s
            free[rows[k] + 1] += 1
    for row in range(size):
        free[row + 1] += free[row]
    by_row, found, rising = np.empty_like(rows), row_starts.copy(), np.empty(len(rows), np.uint32)
    for k in range(len(rows)):
        by_row[free[rows[k]]] = k
        free[rows[k]] += 1
    for k in by_row:
        rising[found[front[k]]] = rows[k]
        found[front[k]] += 1
    return rising


@compiled
def _relative_places(
    starts: np.ndarray, row_starts: np.ndarray, rows: np.ndarray, child: np.ndarray, sibling: np.ndarray
) -> np.ndarray:
    """``Fronts.relative``, indices (r,); the arguments as there, indices (s + 1,), (s + 1,), (r,), (s,) and (s,)."""
    relative, place = np.zeros(len(rows), np.uint32), np.empty(starts[-1], np.uint32)
    for s in range(len(child)):
        for k in range(row_starts[s], row_starts[s + 1]):
            place[rows[k]] = k - row_starts[s]
        c = child[s]
        while c != -1:
            for k in range(row_starts[c] + starts[c + 1] - starts[c], row_starts[c + 1]):
                relative[k] = place[rows[k]]
            c = sibling[c]
    return relative


@compiled
def _update_places(parent: np.ndarray, sizes: np.ndarray) -> tuple[np.ndarray, int]:
    """Where the update matrix of every front begins, indices (s,), and the number of values of the workspace.

    Two stacks take turns over the levels of the tree: a front lies above nothing that is still needed but its children,
    which lie on the other stack. parent: index, -1 for none (s,); sizes: number of rows of the update matrix (s,)
    """
    level = np.zeros(len(parent), np.int64)
    for s in range(len(parent) - 1, -1, -1):
        if parent[s] >= 0:
            level[s] = level[parent[s]] + 1
    places, bottom = np.empty(len(parent), np.int64), np.full(len(parent), -1)  # of the children of a front
    top, most = np.zeros(2, np.int64), np.zeros(2, np.int64)
    for s in range(len(parent)):
        stack = level[s] % 2
        if bottom[s] >= 0:
            top[1 - stack] = bottom[s]
        if parent[s] >= 0 and bottom[parent[s]] < 0:
            bottom[parent[s]] = top[stack]
        places[s] = top[stack]
        top[stack] += sizes[s] ** 2
        most[stack] = max(most[stack], top[stack])
    for s in range(len(parent)):
        places[s] += most[0] * (level[s] % 2)
    return places, most[0] + most[1]


@compiled
def _entry_places(
    starts: np.ndarray,
    row_starts: np.ndarray,
    rows: np.ndarray,
    entries: tuple[np.ndarray, np.ndarray],
    lower: np.ndarray,
) -> np.ndarray:
    """``Fronts.entry_places``, indices (k,); the arguments as there and in ``_structure``, indices (s + 1,), (k,)."""
    places, place = np.empty(len(lower), np.int64), np.empty(starts[-1], np.int64)
    for s in range(len(starts) - 1):
        height = row_starts[s + 1] - row_starts[s]
        for k in range(row_starts[s], row_starts[s + 1]):
            place[rows[k]] = k - row_starts[s]
        for j in range(starts[s], starts[s + 1]):
            for k in range(entries[0][j], entries[0][j + 1]):
                places[k] = (j - starts[s]) * height + place[lower[entries[1][k]]]
    return places
