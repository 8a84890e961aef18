"""Fits by lmfit, as an independent check: lmfit_fits.py NIST_FOLDER SCAN.csv

Prints `fit parameter value standard_error` of four of NIST's reference problems, from their second starts, and of a
BRDF scan by the dd + udf of Li & Torrance 2005 with Schlick's Fresnel term. Nothing of goniofit is used: the formulas
are written anew from the papers. lmfit's standard errors are the classical s^2 (J'J)^-1 (scale_covar).
"""

import sys

import numpy as np
from lmfit import Parameters, minimize

nist_problems = {
    "misra1a": lambda b, x: b[0] * (1 - np.exp(-b[1] * x)),
    "rat43": lambda b, x: b[0] / (1 + np.exp(b[1] - b[2] * x)) ** (1 / b[3]),
    "eckerle4": lambda b, x: b[0] / b[1] * np.exp(-0.5 * ((x - b[2]) / b[1]) ** 2),
    "mgh09": lambda b, x: b[0] * (x**2 + x * b[1]) / (x**2 + x * b[2] + b[3]),
}


def fit(name, names, start, residual):
    parameters = Parameters()
    for key, value in zip(names, start):
        parameters.add(key, value=value)
    result = minimize(
        lambda p: residual([p[key].value for key in names]),
        parameters,
        scale_covar=True,
        xtol=1e-14,
        ftol=1e-14,
        gtol=0,
        max_nfev=20000,
    )
    for key in names:
        p = result.params[key]
        print(f"{name} {key} {p.value:.15e} {p.stderr:.15e}")


def fit_nist(folder, name, model):
    rows = [line.split() for line in open(f"{folder}/{name}.txt")]
    start = [float(r[2]) for r in rows if r[0] == "b"]
    y, x = np.array([[float(v) for v in r[1:]] for r in rows if r[0] == "d"]).T
    fit(name, [f"b{i + 1}" for i in range(len(start))], start, lambda b: model(b, x) - y)


def read_scan(path):
    lines = open(path).read().splitlines()
    metadata = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    index = [complex(v.replace("i", "j")) for v in metadata["refractive_index"].split(",")]
    table = np.array([line.split(",") for line in lines if line[0].isdigit()], dtype=float)
    return index, np.radians(table[:, :4]), table[:, 4:]


def fit_scan(path):
    index, (theta_i, phi_i, theta_r, phi_r), f = (lambda n, a, v: (n, a.T, v))(*read_scan(path))

    def direction(theta, phi):
        return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])

    light, view = direction(theta_i, phi_i), direction(theta_r, phi_r)
    s = light + view
    length2 = (s**2).sum(axis=0)
    u = (view * s).sum(axis=0) / np.sqrt(length2)
    c = np.array([light[2], view[2]])
    tan2 = (s[0] ** 2 + s[1] ** 2) / s[2] ** 2
    weight = np.sqrt(c[0])

    def dd(slope):
        q = 1 / slope
        shadowing = np.prod(1 - (1 - c) ** q, axis=0)
        m_e = slope * np.prod(1 - (1 - c) ** (1.6 * q), axis=0) ** (0.1 * q)
        d = (length2 / s[2]) ** 2 * np.exp(-tan2 / (4 * m_e**2)) / (16 * m_e**2 * s[2] ** 2)
        return shadowing * d / (np.pi * c[0] * c[1])

    f0 = [abs((n - 1) / (n + 1)) ** 2 for n in index]

    def residual(b):
        lobe = dd(b[0])
        parts = []
        for j, r in enumerate(f0):
            fresnel = r + (1 - r) * (1 - u) ** 5
            parts.append(weight * (b[1 + 2 * j] * fresnel * lobe + b[2 + 2 * j] / np.pi - f[:, j]))
        return np.concatenate(parts)

    names = ["slope"] + [k + str(j) for j in range(len(f0)) for k in ("k_dd", "k_udf")]
    fit("scan", names, [0.2] + [0.5, 0.5] * len(f0), residual)


for problem, function in nist_problems.items():
    fit_nist(sys.argv[1], problem, function)
fit_scan(sys.argv[2])
