# SPDX-License-Identifier: Apache-2.0
"""The page of `pelage view` in a real browser, driven by Selenium. Skipped where Debian's chromium, chromium-driver or
python3-selenium or python3-numpy is missing; `./dev setup --browser` installs them. With PELAGE_SCREENSHOTS=DIR, keeps pictures of the page."""
import json
import math
import os
import pathlib
import re
import shutil
import sys
import time
import unittest

try:
    import numpy
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    webdriver = None

from program_view import ProgramTest, ViewTest

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")


class Page(ViewTest):
    def browser(self):
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                         "--window-size=900,600"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        browser = webdriver.Chrome(service=Service(DRIVER), options=options)
        self.addCleanup(browser.quit)
        return browser

    def until(self, holds, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if holds():
                return
            time.sleep(0.05)
        self.fail("never happened")

    def open(self):
        browser = self.browser()
        browser.get(self.url)
        self.until(lambda: self.attribute(browser, "version") > 0)
        return browser

    def settle(self, browser):
        """Waits until the page shows the finished picture of the last edit that the server knows."""
        self.wait(lambda state: state["done"] and self.attribute(browser, "version") == state["version"])

    @staticmethod
    def attribute(browser, name):
        value = browser.execute_script(f"return document.body.dataset.{name}")
        return int(value or 0) if name == "version" else value

    @staticmethod
    def text(browser, name):
        return browser.find_element(By.ID, name).text

    @staticmethod
    def mean(browser):
        """Mean colour of the shown picture, 0 to 255."""
        return browser.execute_script("""
            const c = document.getElementById("canvas"), d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
            let sum = [0, 0, 0], count = 0;
            for (let i = 0; i < d.length; i += 4) if (d[i + 3]) { ++count; for (let k = 0; k < 3; ++k) sum[k] += d[i + k]; }
            return sum.map(s => s / count)""")

    def shoot(self, browser, name):
        folder = os.environ.get("PELAGE_SCREENSHOTS")
        if folder:
            pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
            browser.save_screenshot(os.path.join(folder, name + ".png"))

    def test_refines_follows_and_recovers(self):
        self.view("--set", "image={width: 120, height: 80}", "--set", "render.samples=16")
        browser = self.open()
        self.settle(browser)
        self.assertIn("120 × 80 · done", self.text(browser, "status"))
        self.shoot(browser, "rest")
        before = self.mean(browser)

        # An edit.
        self.replace("radiance: 0.3", "radiance: 1.2")
        self.until(lambda: self.mean(browser)[0] > before[0] + 20)
        self.settle(browser)

        # A wrong edit shows its message and line, and keeps the picture.
        kept = self.mean(browser)
        self.replace("bounces: 1", "bouncs: 1")
        self.until(lambda: "bouncs" in self.text(browser, "error"))
        self.assertIn("scene.yaml:", self.text(browser, "error"))
        self.shoot(browser, "error")
        self.replace("bouncs: 1", "bounces: 1")
        self.until(lambda: not browser.find_element(By.ID, "error").is_displayed())
        self.settle(browser)
        for a, b in zip(self.mean(browser), kept):
            self.assertAlmostEqual(a, b, delta=0.5)

        # Brighter, and another layer in false colours.
        browser.execute_script("const e = document.getElementById('exposure'); e.value = 2;"
                               "e.dispatchEvent(new Event('input'))")
        self.until(lambda: self.mean(browser)[0] > kept[0] + 10)
        chooser = Select(browser.find_element(By.ID, "layer"))
        pictures = {}
        for name in [option.text for option in chooser.options]:
            Select(browser.find_element(By.ID, "layer")).select_by_visible_text(name)
            self.until(lambda: self.attribute(browser, "layer") == name)
            pictures[name] = self.mean(browser)
            self.shoot(browser, "layer_" + name)
        self.assertIn("sky.diffuse", pictures)
        self.assertNotEqual(pictures["N"], pictures["Z"])

        # Values under the cursor, and zoom.
        Select(browser.find_element(By.ID, "layer")).select_by_visible_text("beauty")
        canvas = browser.find_element(By.ID, "canvas")
        webdriver.ActionChains(browser).move_to_element(canvas).perform()
        self.until(lambda: re.search(r"\((59|60), (39|40)\)", self.text(browser, "values")))
        self.until(lambda: re.search(r"R [0-9.]+.*A ", self.text(browser, "values")))
        browser.execute_script("document.getElementById('canvas').dispatchEvent(new WheelEvent('wheel', "
                               "{deltaY: -1000, clientX: 450, clientY: 300, cancelable: true}))")
        self.shoot(browser, "zoomed")
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])

    def test_mixes_lights_and_writes_them_into_the_scene(self):
        self.replace("lights: {sky: {type: environment, radiance: 0.3}}",
                     "lights:  # two\n  key: {type: sphere, position: [5, 8, 5], radius: 2, intensity: 6}  # warm\n"
                     "  sky: {type: environment, radiance: 0.3}\n")
        self.view("--set", "image={width: 120, height: 80, event_layers: true}", "--set", "render.samples=4")
        browser = self.open()
        self.settle(browser)
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

        mixed = sum(layers[f"{light}.{part.replace(' ', '.')}"] * numpy.array(factor)
                    for light, factor in {"key": [2 ** 1.5] * 3, "sky": tint}.items() for part in parts[light])
        unmixed = sum(layers.values())

        # Into the scene: only the values change.
        before = (self.path / "scene.yaml").read_text()
        browser.find_element(By.ID, "light_apply").click()
        self.until(lambda: "intensity: 16.97" in browser.execute_script("return document.getElementById('text').value"))
        self.shoot(browser, "apply")
        browser.find_element(By.ID, "write_text").click()
        self.wait(lambda state: state["edits"] == 1)
        self.settle(browser)
        text = (self.path / "scene.yaml").read_text()
        number = re.search(r"intensity: (16\.97\d*)\}  # warm", text).group(1)
        rgb = re.search(r"radiance: (\[0\.3, 0\.0\d*, 0\])", text).group(1)
        self.assertEqual(text.replace(number, "6").replace(rgb, "0.3"), before)
        self.until(lambda: browser.execute_script("return document.body.dataset.mixed") == "false")
        for name in layers:
            layers[name] = self.layer(name)
        expect({"key": [1, 1, 1], "sky": [1, 1, 1]})
        self.expect_mixed(mixed, unmixed)
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])

    def expect_mixed(self, mixed, unmixed):
        """A mix agrees with renders of the scene as it is now, with other seeds, block by block."""
        def blocks(picture):  # 20 x 20 pixels
            return picture.reshape(4, 20, 6, 20, 3).mean(axis=(1, 3))

        renders, before = [], "render: {"
        for seed in range(1, 25):
            now = f"render: {{seed: {seed}, "
            self.replace(before, now)
            before = now
            self.wait(lambda state: state["done"] and state["edits"] == 1 + seed)
            renders.append(blocks(self.layer("beauty", 4)[:, :, :3]))
        mean, sigma = numpy.mean(renders, axis=0), numpy.std(renders, axis=0, ddof=1)
        # The error of a render, that of the mean, and the rounding of channels to half floats.
        error = numpy.sqrt(sigma ** 2 * (1 + 1 / len(renders)) + (5e-4 * mean) ** 2) + 1e-7
        deviation = abs(blocks(mixed) - mean) / error
        # Of 72 values of Student's t with 23 degrees of freedom, 0.46 are beyond 3 on average, and more than 4 with a
        # probability below 1e-4.
        self.assertLessEqual((deviation > 3).sum(), 4, deviation.round(1))
        self.assertLess(deviation.max(), 6)
        self.assertGreater((abs(blocks(unmixed) - mean) / error > 3).mean(), 0.5, "the test would find a wrong mix")

    def test_explains_a_pixel(self):
        self.view("--set", "image={width: 120, height: 80}", "--set", "render.samples=16",
                  "--set", "grooms.coat.strands=3000", "--set", "render.lod.enabled=false")
        browser = self.open()
        self.settle(browser)
        canvas = browser.find_element(By.ID, "canvas")

        def lit():
            """Pixels of the canvas with the colour of the strand that is drawn over it."""
            return browser.execute_script("""
                const c = document.getElementById("canvas"), d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
                let count = 0;
                for (let i = 0; i < d.length; i += 4) if (d[i] === 255 && d[i + 1] === 180 && d[i + 2] === 84) ++count;
                return count""")

        def click():
            webdriver.ActionChains(browser).move_to_element_with_offset(canvas, 30, 20).click().perform()

        # Without the mode, a click asks nothing.
        self.assertEqual(lit(), 0)
        click()
        self.assertFalse(browser.find_element(By.ID, "why").is_displayed())
        browser.find_element(By.ID, "why_mode").click()
        click()
        self.until(lambda: self.attribute(browser, "why"))
        x, y = map(int, self.attribute(browser, "why").split())
        status, body = self.get("why.json", x=x, y=y)
        answer = json.loads(body)
        self.assertIsNotNone(answer["strand"])
        ids = numpy.frombuffer(self.get("layer.bin", name="id")[1][-4 * 120 * 80:], numpy.uint32).reshape(80, 120)
        self.assertEqual(answer["strand"]["id"], ids[y, x])
        shown = self.text(browser, "why_answer")
        self.assertIn(f"Strand {answer['strand']['id']} of box.coat", shown)
        for what in ("length", "width", "sky diffuse direct", "Material fur (cone-shell)", "grown once"):
            self.assertIn(what, shown)
        self.until(lambda: lit() > 20)
        self.shoot(browser, "why")

        # An edit.
        self.replace("radiance: 0.3", "radiance: 0.6")
        self.until(lambda: "has changed" in self.text(browser, "why_message"))
        self.wait(lambda state: state["edits"] == 1)
        self.settle(browser)
        click()
        self.until(lambda: self.text(browser, "why_message") == "")

        # The background.
        webdriver.ActionChains(browser).send_keys(Keys.ESCAPE).perform()
        self.until(lambda: not browser.find_element(By.ID, "why").is_displayed() and lit() == 0)
        webdriver.ActionChains(browser).key_down(Keys.ALT).move_to_element_with_offset(canvas, -150, -120).click().key_up(
            Keys.ALT).perform()
        self.until(lambda: "only lights" in self.text(browser, "why_answer"))
        self.assertEqual(lit(), 0)
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])

    def test_moves_the_camera(self):
        self.view("--set", "image={width: 120, height: 80}")
        browser = self.open()
        self.settle(browser)
        browser.find_element(By.ID, "camera_mode").click()
        canvas = browser.find_element(By.ID, "canvas")
        first = self.state()["camera"]

        def distance(camera):
            return math.dist(camera["position"], camera["look_at"])

        def moved(act):
            edits = self.state()["edits"]
            # The depth under the centre belongs to the shown picture.
            self.until(lambda: self.attribute(browser, "depth") == str(edits))
            act()
            self.until(lambda: self.state()["edits"] > edits)
            self.until(lambda: self.attribute(browser, "waits") == "false")
            self.settle(browser)
            return self.state()["camera"]

        def drag(x, y, button=0):
            actions = webdriver.ActionChains(browser).move_to_element(canvas)
            builder = actions.w3c_actions
            builder.pointer_action.pointer_down(button=button)
            for _ in range(4):
                builder.pointer_action.move_by(x // 4, y // 4)
            builder.pointer_action.pointer_up(button=button)
            actions.perform()

        orbited = moved(lambda: drag(80, -40))
        self.assertTrue(orbited["moved"])
        # The camera turned about the point of the fur that was in the centre, which is nearer than look_at.
        self.assertLess(distance(orbited), distance(first) - 0.5)
        forward = [(a - b) / distance(first) for a, b in zip(first["look_at"], first["position"])]
        pivot = [p + distance(orbited) * f for p, f in zip(first["position"], forward)]
        for a, b in zip(orbited["look_at"], pivot):
            self.assertAlmostEqual(a, b, places=2)
        self.assertGreater(math.dist(orbited["position"], first["position"]), 1)
        self.shoot(browser, "camera")

        panned = moved(lambda: drag(40, 0, button=2))
        shift = [b - a for a, b in zip(orbited["position"], panned["position"])]
        self.assertGreater(math.hypot(*shift), 0.1)
        dollied = moved(lambda: browser.execute_script(
            "arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: -300, cancelable: true}))", canvas))
        self.assertLess(distance(dollied), distance(panned))

        browser.find_element(By.ID, "camera_text").click()
        self.until(lambda: "position: [" in browser.execute_script("return document.getElementById('text').value"))
        browser.find_element(By.ID, "write_text").click()
        self.until(lambda: not self.state()["camera"]["moved"])
        for a, b in zip(self.state()["camera"]["position"], dollied["position"]):
            self.assertAlmostEqual(a, b, places=4)
        moved(lambda: drag(40, 0))
        browser.find_element(By.ID, "camera_reset").click()
        self.until(lambda: not self.state()["camera"]["moved"])
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])

    def test_a_rectangle_is_refined_first(self):
        self.view("--set", "image={width: 120, height: 80}", "--set", "render.samples=100000")
        browser = self.open()
        canvas = browser.find_element(By.ID, "canvas")

        def drag():
            webdriver.ActionChains(browser).move_to_element_with_offset(canvas, -60, -40).click_and_hold().move_by_offset(
                90, 60).release().perform()

        webdriver.ActionChains(browser).key_down(Keys.SHIFT).perform()
        drag()
        webdriver.ActionChains(browser).key_up(Keys.SHIFT).perform()
        self.until(lambda: self.state()["region"])
        region = self.state()["region"]
        self.assertGreater(region[0], 30)
        self.assertLess(region[2], 90)
        button = browser.find_element(By.ID, "region_mode")
        self.until(lambda: button.text == "Clear region")
        self.shoot(browser, "region")
        button.click()
        self.until(lambda: self.state()["region"] is None and button.text == "Region")
        button.click()  # the mode, without Shift
        drag()
        self.until(lambda: self.state()["region"] == region)
        browser.find_element(By.TAG_NAME, "body").send_keys(Keys.ESCAPE)
        self.until(lambda: self.state()["region"] is None)

    def layer(self, name, channels=3):
        """A layer of radiance as an array [row, column, channel]."""
        _, body = self.get("layer.bin", name=name)
        head = json.loads(body[:body.index(b"\n")])
        halves = numpy.frombuffer(body, numpy.float16, offset=body.index(b"\n") + 1).astype(float)
        return halves.reshape(channels, head["height"], head["width"]).transpose(1, 2, 0)

    @staticmethod
    def shown(browser):
        """The whole picture as the page shows it, in pixels of the picture."""
        values = browser.execute_script("""
            const c = document.getElementById("canvas").picture;
            return [c.width, c.height, ...c.getContext("2d").getImageData(0, 0, c.width, c.height).data]""")
        return numpy.array(values[2:]).reshape(values[1], values[0], 4)[:, :, :3]

    def test_two_pages_at_once_and_reloads(self):
        self.view()
        pages = [self.open(), self.open()]
        for _ in range(10):
            pages[0].refresh()
        self.replace("radiance: 0.3", "radiance: 0.9")
        self.wait(lambda state: state["edits"] == 1)
        for page in pages:
            self.settle(page)
        self.until(lambda: self.mean(pages[0]) == self.mean(pages[1]))


if __name__ == "__main__":
    if webdriver is None or not CHROMIUM or not DRIVER:
        print("skipped: needs chromium, chromium-driver, python3-selenium and python3-numpy")
        sys.exit(77)
    ProgramTest.PELAGE = sys.argv.pop(1)
    unittest.main()
