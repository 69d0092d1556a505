"""A bench that is linear in everything, so that the best set of effects can be found by trying all of them."""

from itertools import combinations

import numpy as np

from workbench.explain.explore import Beliefs, Names
from workbench.likelihood.marginal import Catalogue, Term, Terms

ODDS = np.log(0.05 / 0.95)
ANY = np.array([[-1e3, 1e3]])


def names_of(shapes, places=(-2.0, -1.0, 1.0, 2.0), background=None):
    """Effects e0, e1, ... on a grid of four sizes, each with one column. shapes: whitened change by size one (n, e)"""
    rows, effects = shapes.shape
    background = 0.5 * np.ones((rows, 1)) if background is None else background
    terms = [
        Term(f"e{k}", place * shapes[:, k], 0.4 * shapes[:, k : k + 1], -np.log(len(places)), ANY, 0, number)
        for k in range(effects)
        for number, place in enumerate(places)
    ]
    return Names(Catalogue(background, Terms(tuple(terms), rows)))


def beliefs(names, excluded=()):
    return Beliefs({name: ODDS for name in names.order}, frozenset(map(frozenset, excluded)))


def by_force(names, residual, most):
    """Every set of effects and ln p over nothing, all sizes tried: the answer a search cannot beat."""
    catalogue, readings = names.catalogue, names.catalogue.readings(residual[:, None])[0]
    null = catalogue.given(()).log_marginal(readings)
    found = {frozenset(): 0.0}
    for count in range(1, most + 1):
        for chosen in combinations(names.order, count):
            choices = [[t for t, term in enumerate(catalogue.terms) if term.name == name] for name in chosen]
            grids = np.array(np.meshgrid(*choices)).reshape(count, -1).T
            logs = [catalogue.given(tuple(g)).log_marginal(readings) + names.priors[g].sum() for g in grids]
            found[frozenset(chosen)] = float(np.logaddexp.reduce(logs)) - null
    return found
