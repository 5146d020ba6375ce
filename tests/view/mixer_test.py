# SPDX-License-Identifier: Apache-2.0
"""The light mixer of the page of `pelage view` in a real browser."""
import re

try:
    import numpy
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    pass

from program_page import PageTest, run_tests


class Mixer(PageTest):
    def test_mixes_lights_and_writes_them_into_the_scene(self):
        self.replace("lights: {sky: {type: environment, radiance: 0.3}}",
                     "lights:  # two\n  key: {type: sphere, position: [5, 8, 5], radius: 2, intensity: 6}  # warm\n"
                     "  sky: {type: environment, radiance: 0.3}\n")
        self.view("--set", "image={width: 120, height: 80, event_layers: true}", "--set", "render.samples=4")
        browser = self.open()
        self.until(lambda: self.attribute(browser, "done") == "true")
        renders = self.state()["version"]
        browser.find_element(By.ID, "lights_mode").click()
        self.until(lambda: browser.find_elements(By.CLASS_NAME, "light"))
        rows = {row.get_attribute("data-light"): row for row in browser.find_elements(By.CLASS_NAME, "light")}
        self.assertEqual(sorted(rows), ["key", "sky"])
        Select(browser.find_element(By.ID, "transform")).select_by_visible_text("sRGB only")

        def move(light, kind, value):
            browser.execute_script("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))",
                                   rows[light].find_element(By.CSS_SELECTOR, f"input[type={kind}]"), value)

        def press(light, text):
            buttons = {button.text: button for button in rows[light].find_elements(By.TAG_NAME, "button")}
            buttons[text].click()

        parts = {light: [b.text for b in row.find_elements(By.CSS_SELECTOR, ".lobes button")] for light, row in rows.items()}
        self.assertIn("emission", parts["sky"])
        self.assertIn("diffuse indirect", parts["key"])
        layers = {f"{light}.{part.replace(' ', '.')}": None for light in rows for part in parts[light]}
        for name in layers:
            layers[name] = self.layer(name)

        def expect(factors, without=()):
            """The shown picture is the sum of the layers times the factors of their lights."""
            total = sum(layers[f"{light}.{part.replace(' ', '.')}"] * numpy.array(factor)
                        for light, factor in factors.items() for part in parts[light] if (light, part) not in without)
            srgb = numpy.where(total <= 0.0031308, 12.92 * total, 1.055 * numpy.maximum(total, 0.001) ** (1 / 2.4) - 0.055)
            wanted = numpy.floor(255 * numpy.clip(srgb, 0, 1) + 0.5)
            self.until(lambda: abs(self.shown(browser) - wanted).max() <= 1, 10)

        expect({"key": [1, 1, 1], "sky": [1, 1, 1]})
        move("key", "range", 1.5)
        expect({"key": [2 ** 1.5] * 3, "sky": [1, 1, 1]})
        move("sky", "color", "#ff8000")
        tint = [1, ((128 / 255 + 0.055) / 1.055) ** 2.4, 0]
        expect({"key": [2 ** 1.5] * 3, "sky": tint})
        press("sky", "emission")
        press("key", "diffuse indirect")
        expect({"key": [2 ** 1.5] * 3, "sky": tint}, {("sky", "emission"), ("key", "diffuse indirect")})
        self.shoot(browser, "mixer")
        press("sky", "M")
        expect({"key": [2 ** 1.5] * 3}, {("key", "diffuse indirect")})
        press("sky", "M")
        press("sky", "S")
        expect({"sky": tint}, {("sky", "emission")})
        press("sky", "S")
        press("sky", "emission")
        press("key", "diffuse indirect")
        webdriver.ActionChains(browser).key_down(Keys.ALT).perform()
        press("key", "diffuse direct")
        expect({"key": [2 ** 1.5] * 3, "sky": tint}, {("key", part) for part in parts["key"] if part != "diffuse direct"})
        webdriver.ActionChains(browser).move_to_element(browser.find_element(By.ID, "canvas")).perform()
        at_cursor = r"\((\d+), (\d+)\)  R (\S+)"
        self.until(lambda: re.match(at_cursor, self.text(browser, "values")))
        place = re.match(at_cursor, self.text(browser, "values"))
        x, y, red = int(place[1]), int(place[2]), float(place[3])
        total = 2 ** 1.5 * layers["key.diffuse.direct"] + sum(layers[f"sky.{p.replace(' ', '.')}"] for p in parts["sky"]) * tint
        self.assertAlmostEqual(red, total[y, x, 0], delta=2e-3 * red + 1e-6)
        press("key", "diffuse direct")
        webdriver.ActionChains(browser).key_up(Keys.ALT).perform()
        expect({"key": [2 ** 1.5] * 3, "sky": tint})
        self.assertEqual(self.state()["version"], renders, "nothing was rendered")

        # Into the scene: only the values change.
        before = (self.path / "scene.yaml").read_text()
        browser.find_element(By.ID, "light_apply").click()
        self.until(lambda: "intensity: 16.97" in browser.execute_script("return document.getElementById('text').value"))
        self.shoot(browser, "apply")
        browser.find_element(By.ID, "write_text").click()
        self.shows(browser, 1)
        text = (self.path / "scene.yaml").read_text()
        number = re.search(r"intensity: (16\.97\d*)\}  # warm", text).group(1)
        rgb = re.search(r"radiance: (\[0\.3, 0\.0\d*, 0\])", text).group(1)
        self.assertEqual(text.replace(number, "6").replace(rgb, "0.3"), before)
        self.until(lambda: browser.execute_script("return document.body.dataset.mixed") == "false")
        for name in layers:
            layers[name] = self.layer(name)
        expect({"key": [1, 1, 1], "sky": [1, 1, 1]})
        text = (self.path / "scene.yaml").read_text()
        self.expect_mixed(text, before, {f"{light}.{part.replace(' ', '.')}": numpy.array(factor) for light, factor in
                                         {"key": [2 ** 1.5] * 3, "sky": tint}.items() for part in parts[light]})
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])

    def expect_mixed(self, rendered, mixed, factors):
        """The layers of the scene `mixed`, times factors, agree with renders of the scene `rendered`, block by block."""
        def blocks(text, seeds, picture):  # of 20 x 20 pixels: mean over the seeds and its standard error
            pictures = []
            for seed in seeds:
                self.write(text.replace("render: {", f"render: {{seed: {seed}, "))
                self.edits += 1
                self.wait(lambda state: state["done"] and state["edits"] == self.edits)
                pictures.append(picture().reshape(4, 20, 6, 20, 3).mean(axis=(1, 3)))
            return numpy.mean(pictures, axis=0), numpy.std(pictures, axis=0, ddof=1) / len(pictures) ** 0.5

        self.edits = self.state()["edits"]
        wanted, error = blocks(rendered, range(1, 21), lambda: self.layer("beauty", 4)[:, :, :3])
        mix, mix_error = blocks(mixed, range(21, 41), lambda: sum(self.layer(name) * f for name, f in factors.items()))
        unmixed = sum(self.layer(name) for name in factors).reshape(4, 20, 6, 20, 3).mean(axis=(1, 3))
        # With the rounding of channels to half floats.
        sigma = numpy.sqrt(error ** 2 + mix_error ** 2 + (5e-4 * wanted) ** 2) + 1e-7
        deviation = abs(mix - wanted) / sigma
        # Of 72 values of Student's t with 20 to 38 degrees of freedom, at most 0.5 are beyond 3 on average, and more than 4
        # with a probability below 1e-3.
        self.assertLessEqual((deviation > 3).sum(), 4, deviation.round(1))
        self.assertLess(deviation.max(), 6)
        self.assertGreater((abs(unmixed - wanted) / sigma > 3).mean(), 0.5, "the test would find a wrong mix")


if __name__ == "__main__":
    run_tests()
