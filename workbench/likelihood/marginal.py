"""One low-rank Gaussian likelihood: readings explained by terms with standard normal weights.

    r = background w_0 + sum over terms of (shift + columns w) + noise,   w, noise ~ N(0, 1)   (all whitened)

The background is in every explanation: declared tolerances and instruments, the numerical error of the model, an
unknown function where one is believed in. Terms are effects at a place of their size. With the weights integrated out

    ln p(r) = -1/2 (|r'|^2 - b^T A^-1 b + ln det A),   r' = r - shifts,  A = 1 + X^T X,  b = X^T r'

All of it is read from products of columns with one another, so that one more explanation costs microseconds.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from workbench.likelihood.whitening import LawError


@dataclass(frozen=True, eq=False)
class Term:
    """An effect at one place of its size, whitened.

    name: of the effect;  shift: what it adds there (n,);  columns: how that changes with its weights (n, k)
    log_prior: ln of the prior share of the place among all terms of the name [1]
    reach: smallest and largest weight of every column that the place stands for (k, 2)
    variant, place: numbers of the form of the effect and of the place on its grid
    """

    name: str
    shift: np.ndarray
    columns: np.ndarray
    log_prior: float
    reach: np.ndarray
    variant: int = 0
    place: int = 0


@dataclass(frozen=True, eq=False)
class Readings:
    """What the likelihood needs of residuals, less what a background takes of it.

    on: products with all columns of the terms of a catalogue (Q,);  square: |r|^2
    """

    on: np.ndarray
    square: float


@dataclass(frozen=True, eq=False)
class Terms:
    """All terms that there are, of so many rows, and the products of what they add with one another.

    kept: ``columns``, where the terms are views of it
    """

    all: tuple[Term, ...]
    rows: int
    kept: np.ndarray | None = None

    @classmethod
    def in_one(cls, terms: Iterable[Term], rows: int, count: int) -> Terms:
        """Terms with so many columns altogether as views of one array, each written there as it comes: there may be
        100 MB of them."""
        out, found, first = np.empty((rows, count)), [], 0
        for term in terms:
            end = first + 1 + term.columns.shape[1]
            out[:, first], out[:, first + 1 : end] = term.shift, term.columns
            found.append(replace(term, shift=out[:, first], columns=out[:, first + 1 : end]))
            first = end
        return cls(tuple(found), rows, out)

    @cached_property
    def columns(self) -> np.ndarray:
        """Of every term its shift and its columns (n, Q)."""
        if self.kept is not None:
            return self.kept
        every = [np.column_stack([term.shift, term.columns]) for term in self.all]
        return np.hstack([np.empty((self.rows, 0)), *every])

    @cached_property
    def own(self) -> tuple[np.ndarray, ...]:
        """Products of what each term adds with one another (1 + k, 1 + k)."""
        sizes = [1 + term.columns.shape[1] for term in self.all]
        each = np.split(self.columns, np.cumsum(sizes)[:-1], axis=1) if sizes else []
        return tuple(columns.T @ columns for columns in each)

    def products(self, places: np.ndarray) -> np.ndarray:
        """Of the columns at these places with all columns (k, Q). Few terms are ever in an explanation: what was asked
        for is kept, products of all would take more memory than the columns."""
        new = [place for place in dict.fromkeys(places.tolist()) if place not in self._known]
        if new:
            self._known.update(zip(new, self.columns[:, new].T @ self.columns))
        return np.array([self._known[place] for place in places.tolist()]).reshape(len(places), self.columns.shape[1])

    @cached_property
    def _known(self) -> dict[int, np.ndarray]:
        """Products of a column with all (Q,), by its place."""
        return {}

    @cached_property
    def names(self) -> np.ndarray:
        """Of the effect that every column is of (Q,)."""
        return np.repeat([term.name for term in self.all], [1 + term.columns.shape[1] for term in self.all])


@dataclass(frozen=True, eq=False)
class Carried:
    """What tolerances do more where an explanation is looked for than where its terms were made. Of what an effect does
    there, the part that tolerances could do is taken as they do it here: or the difference of the two, times all that
    tolerances were pulled by, would explain whatever it is like.

    change: of what tolerances do, whitened (n, r);  shares: of tolerances in the columns of all terms (r, Q)
    """

    change: np.ndarray
    shares: np.ndarray

    @classmethod
    def nowhere(cls, terms: Terms) -> Carried:
        """Where they were made."""
        return cls(np.empty((terms.rows, 0)), np.empty((0, terms.columns.shape[1])))

    def products(self, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """E and F of what is added to products of the columns with one another, a^T F + e^T A for places with shares a
        of all shares A (r, Q) each: E = change^T columns, F = E + change^T change A."""
        before = self.change.T @ columns
        return before, before + (self.change.T @ self.change) @ self.shares


@dataclass(frozen=True, eq=False)
class Catalogue:
    """The terms that an explanation may be made of, beside a background (n, m) that is in every one.

    laws: errors of laws that are integrated out besides, one of a row at most. The background feels them already, the
    terms do not yet
    without: effects whose terms are left out
    elsewhere: what is changed in the terms to stand beside the background, None where they were made beside it

    What laws and another place change in the products of the terms is of low rank.
    """

    background: np.ndarray
    whole: Terms
    laws: tuple[LawError, ...] = ()
    without: frozenset[str] = frozenset()
    elsewhere: Carried | None = None

    @cached_property
    def carried(self) -> Carried:
        """What is changed, of no columns where nothing is."""
        return self.elsewhere or Carried.nowhere(self.whole)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        return tuple(self.whole.all[number] for number in self._numbers)

    @cached_property
    def _numbers(self) -> list[int]:
        """Of the terms among all."""
        return [number for number, term in enumerate(self.whole.all) if term.name not in self.without]

    @cached_property
    def _kept(self) -> np.ndarray:
        """Places of their columns among those of all (Q,)."""
        return np.flatnonzero(~np.isin(self.whole.names, sorted(self.without)))

    @cached_property
    def first(self) -> np.ndarray:
        """Place of the shift of every term among their columns, and one past the last (terms + 1,)."""
        return np.concatenate([[0], np.cumsum([1 + term.columns.shape[1] for term in self.terms])]).astype(int)

    @cached_property
    def root(self) -> np.ndarray:
        """Of what is left of the background's weights (m, m)."""
        return np.linalg.cholesky(np.eye(self.background.shape[1]) + self.background.T @ self.background)

    @property
    def half_log_det(self) -> float:
        """What the background costs every explanation alike [nats]."""
        return float(np.log(np.diagonal(self.root)).sum())

    @cached_property
    def _behind(self) -> np.ndarray:
        """What the background takes of the products of the terms' columns, as the products of these (m, Q)."""
        return np.linalg.solve(self.root, self._on(self.background).T)

    @cached_property
    def _taken(self) -> np.ndarray:
        """What the laws take, and the background (q, Q)."""
        laws = [self._taken_by(law).take(self._kept, axis=1) for law in self.laws]
        return np.vstack([*laws, self._behind])

    def _taken_by(self, law: LawError) -> np.ndarray:
        """What a law takes of the columns of all terms (q, Q)."""
        carried = self.carried
        return law.taken(self.whole.columns[law.rows]) + law.taken(carried.change[law.rows]) @ carried.shares

    @cached_property
    def _carried(self) -> tuple[np.ndarray, np.ndarray]:
        """E and F of ``Carried.products``."""
        return self.carried.products(self.whole.columns)

    def products(self, places: np.ndarray) -> np.ndarray:
        """Of the terms' columns at these places with all of them, laws and background integrated out (k, Q)."""
        kept, shares, (before, after) = self._kept[places], self.carried.shares, self._carried
        own = self.whole.products(kept) + shares[:, kept].T @ after + before[:, kept].T @ shares
        return own.take(self._kept, axis=1) - self._taken[:, places].T @ self._taken

    @cached_property
    def blocks(self) -> dict[int, np.ndarray]:
        """Products of what each term adds, by how many columns they have (t, 1 + k, 1 + k)."""
        return {size: self._blocks(which, size) for size, which in self.by_size.items()}

    def _blocks(self, which: np.ndarray, size: int) -> np.ndarray:
        places = self.first[which][:, None] + np.arange(1 + size)
        own = np.stack([self.whole.own[self._numbers[t]] for t in which])
        shares, before, after = (of[:, self._kept[places]] for of in (self.carried.shares, *self._carried))
        own = own + shares.transpose(1, 2, 0) @ after.swapaxes(0, 1) + before.transpose(1, 2, 0) @ shares.swapaxes(0, 1)
        taken = self._taken[:, places].transpose(1, 2, 0)
        return own - taken @ taken.transpose(0, 2, 1)

    def _on(self, whitened: np.ndarray) -> np.ndarray:
        """Products of the terms' columns with whitened ones (n, R) that feel the laws (Q, R)."""
        felt = whitened.copy()
        for law in self.laws:
            felt[law.rows] = law.apply(felt[law.rows])
        products = self.whole.columns.T @ felt + self.carried.shares.T @ (self.carried.change.T @ felt)
        return products[self._kept]

    def readings(self, residuals: np.ndarray) -> list[Readings]:
        """Of whitened residuals (n, R), the background integrated out."""
        own = np.linalg.solve(self.root, self.background.T @ residuals)
        products = self._on(residuals) - self._behind.T @ own
        squares = np.sum(residuals**2, axis=0) - np.sum(own**2, axis=0)
        return [Readings(products[:, k], float(squares[k])) for k in range(residuals.shape[1])]

    def gains(self, chosen: Sequence[int], readings: Sequence[Readings]) -> np.ndarray:
        """ln p that each term would gain beside the terms of these numbers, for many readings (terms, R) [nats]."""
        given = self.given(chosen)
        on = np.column_stack([r.on for r in readings]) - given.of_shifts[:, None]
        taken, own = given.taken_of(on)
        out = np.empty((len(self.terms), len(readings)))
        for size, which in self.by_size.items():
            out[which] = given.gains_of(which, size, taken, on, own)
        return out

    def given(self, chosen: Sequence[int]) -> Given:
        """The likelihood with the terms of these numbers in the explanation."""
        columns = [np.arange(self.first[t] + 1, self.first[t + 1]) for t in chosen]
        inside = np.concatenate([np.empty(0, dtype=int), *columns])
        return Given(self, inside, self.first[list(chosen)].astype(int))

    def felt(self, number: int) -> np.ndarray:
        """Whitened shift of the term of a number and its columns, the errors of laws integrated out (n, 1 + k)."""
        term = self.terms[number]
        own = self._kept[self.first[number] : self.first[number + 1]]
        out = np.column_stack([term.shift, term.columns]) + self.carried.change @ self.carried.shares[:, own]
        for law in self.laws:
            out[law.rows] = law.apply(out[law.rows])
        return out

    def reach(self, chosen: Sequence[int]) -> np.ndarray:
        """Smallest and largest weights of the columns of the terms of these numbers (2, k)."""
        return np.vstack([np.empty((0, 2)), *(self.terms[t].reach for t in chosen)]).T

    @cached_property
    def by_size(self) -> dict[int, np.ndarray]:
        """Numbers of the terms by how many columns they have."""
        sizes = np.diff(self.first) - 1
        return {int(k): np.flatnonzero(sizes == k) for k in np.unique(sizes)}

    @cached_property
    def reaches(self) -> dict[int, np.ndarray]:
        """Reach of the terms of each size (t, k, 2)."""
        return {k: np.stack([self.terms[t].reach for t in which]) for k, which in self.by_size.items()}


@dataclass(frozen=True, eq=False)
class Given:
    """An explanation. inside: places of its columns;  shifts: places of its shifts"""

    catalogue: Catalogue
    inside: np.ndarray
    shifts: np.ndarray

    @cached_property
    def _own(self) -> np.ndarray:
        """Products of the columns inside with all (q, Q)."""
        return self.catalogue.products(self.inside)

    @cached_property
    def _root(self) -> np.ndarray:
        return root_beside_one(self._own[None, :, self.inside])[0]

    @cached_property
    def of_shifts(self) -> np.ndarray:
        """Products of the sum of the shifts with all columns (Q,)."""
        return self.catalogue.products(self.shifts).sum(axis=0)

    def taken_of(self, on: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What the columns inside take of every column (q, Q), and of residuals (q, R).

        on: products of all columns with the residuals (Q, R)
        """
        turned = np.linalg.inv(self._root)
        return turned @ self._own, turned @ on[self.inside]

    def log_marginal(self, readings: Readings) -> float:
        """ln p of readings, up to what all explanations share [nats]."""
        shifts, taken = self.shifts, self.taken_of((readings.on - self.of_shifts)[:, None])[1][:, 0]
        square = readings.square - 2 * readings.on[shifts].sum() + self.of_shifts[shifts].sum()
        spread = np.log(np.diagonal(self._root)).sum() + self.catalogue.half_log_det
        return float(-0.5 * (square - taken @ taken) - spread)

    def gains_of(self, which: np.ndarray, size: int, taken: np.ndarray, on: np.ndarray, own: np.ndarray) -> np.ndarray:
        """Of terms with the same number of columns, for residuals as ``taken_of`` has them (t, R) [nats]."""
        places = self.catalogue.first[which][:, None] + np.arange(1 + size)
        beside = taken[:, places].transpose(1, 2, 0)  # (t, 1 + k, q)
        gram = self.catalogue.blocks[size] - beside @ beside.transpose(0, 2, 1)
        left = on[places] - beside @ own  # (t, 1 + k, R)
        root = root_beside_one(gram[:, 1:, 1:])
        moved = np.linalg.solve(root, left[:, 1:] - gram[:, 1:, :1])
        spread = np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1)
        gain = left[:, 0] - 0.5 * gram[:, 0, :1] + 0.5 * np.sum(moved**2, axis=1) - spread[:, None]
        return gain - _out_of_reach(root, moved, self.catalogue.reaches[size])


def root_beside_one(gram: np.ndarray) -> np.ndarray:
    """Cholesky's factor of 1 + A of products A of columns with one another (t, k, k). None is negative; where columns
    of 1e8 standard deviations leave all but nothing beside others, round-off makes them so."""
    one = np.eye(gram.shape[-1])
    try:
        return np.linalg.cholesky(one + gram)
    except np.linalg.LinAlgError:
        sizes, directions = np.linalg.eigh(gram)
        half = np.sqrt(1.0 + np.maximum(sizes, 0.0))[..., None] * directions.transpose(0, 2, 1)
        root = np.linalg.qr(half, mode="r").transpose(0, 2, 1)  # of half^T half, which is never formed
        return root * np.sign(np.diagonal(root, axis1=1, axis2=2))[:, None, :]


def _out_of_reach(root: np.ndarray, moved: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """What expected weights beyond their reach lose where they are held there [nats] (t, R): linear algebra would make
    a friction negative where the model cannot. root: of A (t, k, k);  moved: root^T times the weights (t, k, R)"""
    upper = root.transpose(0, 2, 1)
    weights = np.linalg.solve(upper, moved)
    held = np.clip(weights, reach[:, :, :1], reach[:, :, 1:])
    return 0.5 * np.sum((upper @ (weights - held)) ** 2, axis=1)
