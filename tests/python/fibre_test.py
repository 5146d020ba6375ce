# SPDX-License-Identifier: Apache-2.0
"""Fibre models on arrays."""
import unittest

import numpy as np
import pelage


class Fibres(unittest.TestCase):
    def test_the_integral_is_the_albedo(self):
        for model in ("lambert-cylinder", "kajiya-kay", "chiang", "deon"):
            fibre = pelage.Fibre(model)
            wo = fibre.direction(0.3, 0)
            # Roughness of the defaults: a rule of 160 x 320 directions resolves their lobes to a few thousandths.
            error = np.abs(fibre.integrate(wo, 0.4, steps=160) - fibre.albedo(wo, 0.4)).max()
            self.assertLess(error, 0.01, model)

    def test_samples_estimate_the_integral(self):
        fibre = pelage.Fibre("chiang", color=[0.6, 0.4, 0.2], beta_m=0.4)
        wo = fibre.direction(0.2, 0)
        u = (np.random.default_rng(1).random((4096, 3)) * (1 - 1e-6)).astype(np.float32)
        wi, rho, pdf = fibre.sample(wo, u, 0.3)
        self.assertTrue(np.allclose(fibre.pdf(wo, wi, 0.3), pdf, rtol=1e-3))
        self.assertTrue(np.allclose(fibre.evaluate(wo, wi, 0.3), rho, rtol=1e-3))
        # 4,096 samples of a weight near 1: a standard error below 0.01; 5 of them.
        self.assertLess(np.abs((rho / pdf[:, None]).mean(axis=0) - fibre.albedo(wo, 0.3)[0]).max(), 0.05)

    def test_lobes_add_up(self):
        fibre = pelage.Fibre({"model": "marschner"})
        phi = np.linspace(-3, 3, 7)
        wi = fibre.direction(-0.1, phi)
        lobes = fibre.lobes([0, 1, 0], wi)
        self.assertEqual(set(lobes), {"diffuse", "primary", "secondary"})
        self.assertTrue(np.allclose(sum(lobes.values()), fibre.evaluate([0, 1, 0], wi)))

    def test_mistakes_are_named(self):
        with self.assertRaises(pelage.Error) as caught:
            pelage.Fibre("chiangg")
        self.assertEqual((caught.exception.nearest, caught.exception.file), ("chiang", "model"))
        with self.assertRaisesRegex(pelage.Error, "expected the model of a fibre"):
            pelage.Fibre("lambert")
        fibre = pelage.Fibre("chiang")
        for arguments, kind, message in [
            (([0, 2, 0], [0, 1, 0]), ValueError, "wo: expected unit vectors"),
            (([0, 1, 0], [0, 1]), ValueError, r"wi: expected the shape \(3,\) or \(n, 3\), got \(2,\)"),
            (([0, 1, 0], [0, 1, 0], 2), ValueError, "h: expected numbers from -1 to 1"),
            (([0, 1, 0], "up"), TypeError, "wi: expected numbers"),
            (([[0, 1, 0]] * 2, [[0, 1, 0]] * 3), ValueError, "different numbers of rows: wo 2, wi 3, h 1"),
        ]:
            with self.assertRaisesRegex(kind, message):
                fibre.evaluate(*arguments)


if __name__ == "__main__":
    unittest.main()
