#!/usr/bin/env python3
"""The corrections Q_n of src/terms/he_torrance_saddle.h, exactly, in the layout of its tables.

The summand g^j e^-g/(j! j) e^(-x/j), j = J(1+t), J = g e^w, x = w J², with j! by Stirling's series, is
exp(-J (1+2w) t²/2) J^(-3/2) times
    exp{ J sum_{k>=3} (-1)^(k+1) (w + 1/(k(k-1))) t^k - sum_n B_2n/(2n(2n-1)) (J(1+t))^(1-2n) } (1+t)^(-3/2).
Expanded in t and 1/J and integrated over the Gaussian, that is 1 + sum_n Q_n(v)/J^n, v = 1/(1+2w).
"""

from fractions import Fraction
from math import comb, lcm, prod

ORDER = 6
HALF_ORDERS = 2 * ORDER  # t counts 1/2, 1/J counts 1
BERNOULLI = [Fraction(1, 6), Fraction(-1, 30), Fraction(1, 42), Fraction(-1, 30)]


def add_product(total, a, b, factor):
    """total += factor a b, polynomials in w as lists."""
    total.extend([Fraction(0)] * (len(a) + len(b) - 1 - len(total)))
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            total[i + j] += factor * x * y


def logarithm():
    """{half orders: {power of t: polynomial in w}} of the logarithm of what multiplies the Gaussian."""
    terms = {}

    def add(order, power, polynomial):
        if order <= HALF_ORDERS:
            add_product(terms.setdefault(order, {}).setdefault(power, []), polynomial, [Fraction(1)], 1)

    for k in range(3, HALF_ORDERS + 3):
        sign = Fraction((-1) ** (k + 1))
        add(k - 2, k, [sign / (k * (k - 1)), sign])
    for k in range(1, HALF_ORDERS + 1):
        add(k, k, [Fraction(3 * (-1) ** k, 2 * k)])
    for n, b in enumerate(BERNOULLI, 1):
        q = 2 * n - 1
        for m in range(HALF_ORDERS + 1):
            add(m + 2 * q, m, [-b / (2 * n * q) * (-1) ** m * comb(q + m - 1, m)])
    return terms


def exponential(log):
    """E of E' = L' E, order by order."""
    e = {0: {0: [Fraction(1)]}}
    for order in range(1, HALF_ORDERS + 1):
        e[order] = {}
        for k in range(1, order + 1):
            for m1, p1 in log.get(k, {}).items():
                for m2, p2 in e[order - k].items():
                    add_product(e[order].setdefault(m1 + m2, []), p1, p2, Fraction(k, order))
    return e


def correction(terms):
    """The Gaussian mean of terms {power of t: polynomial in w}, by ascending power of v; w = (1/v - 1)/2."""
    q = {}
    for m, polynomial in terms.items():
        moment = prod(range(1, m, 2))  # E[t^m] = (m-1)!! (v/J)^(m/2)
        for i, c in enumerate(polynomial):
            for l in range(i + 1):
                power = m // 2 - i + l
                q[power] = q.get(power, 0) + c * moment * comb(i, l) * (-1) ** l / Fraction(2) ** i
    return [q.get(k, Fraction(0)) for k in range(max(k for k in q if q[k]) + 1)]


if __name__ == "__main__":
    expansion = exponential(logarithm())
    for n in range(1, ORDER + 1):
        q = correction(expansion[2 * n])
        denominator = lcm(*(c.denominator for c in q))
        print(f"saddle_{n}: {denominator}; " + ", ".join(str(int(c * denominator)) for c in q))
