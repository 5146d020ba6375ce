# SPDX-License-Identifier: Apache-2.0
"""The page of `pelage view` in a real browser, driven by Selenium. Skipped where Debian's chromium, chromium-driver or
python3-selenium is missing; `./dev setup --browser` installs them. With PELAGE_SCREENSHOTS=DIR, keeps pictures of the page."""
import os
import pathlib
import shutil
import sys
import time
import unittest

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
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
        self.until(lambda: self.attribute(browser, "done") == "true")
        self.assertIn("120 × 80 · done", self.text(browser, "status"))
        self.shoot(browser, "rest")
        before = self.mean(browser)

        # An edit.
        self.replace("radiance: 0.3", "radiance: 1.2")
        self.until(lambda: self.mean(browser)[0] > before[0] + 20)
        self.until(lambda: self.attribute(browser, "done") == "true")

        # A wrong edit shows its message and line, and keeps the picture.
        kept = self.mean(browser)
        self.replace("bounces: 1", "bouncs: 1")
        self.until(lambda: "bouncs" in self.text(browser, "error"))
        self.assertIn("scene.yaml:", self.text(browser, "error"))
        self.shoot(browser, "error")
        self.replace("bouncs: 1", "bounces: 1")
        self.until(lambda: not browser.find_element(By.ID, "error").is_displayed())
        self.until(lambda: self.attribute(browser, "done") == "true")
        for a, b in zip(self.mean(browser), kept):
            self.assertAlmostEqual(a, b, delta=0.5)

        # Brighter, and another layer in false colours.
        browser.execute_script("const e = document.getElementById('exposure'); e.value = 2;"
                               "e.dispatchEvent(new Event('input'))")
        self.assertGreater(self.mean(browser)[0], kept[0] + 10)
        chooser = Select(browser.find_element(By.ID, "layer"))
        pictures = {}
        for name in [option.text for option in chooser.options]:
            Select(browser.find_element(By.ID, "layer")).select_by_visible_text(name)
            time.sleep(0.4)
            pictures[name] = self.mean(browser)
            self.shoot(browser, "layer_" + name)
        self.assertIn("sky.diffuse", pictures)
        self.assertNotEqual(pictures["N"], pictures["Z"])

        # Values under the cursor, and zoom.
        Select(browser.find_element(By.ID, "layer")).select_by_visible_text("beauty")
        canvas = browser.find_element(By.ID, "canvas")
        webdriver.ActionChains(browser).move_to_element(canvas).perform()
        self.until(lambda: "(60, 40)" in self.text(browser, "values") or "(59, 39)" in self.text(browser, "values"))
        self.assertRegex(self.text(browser, "values"), r"R [0-9.]+.*A ")
        browser.execute_script("document.getElementById('canvas').dispatchEvent(new WheelEvent('wheel', "
                               "{deltaY: -1000, clientX: 450, clientY: 300, cancelable: true}))")
        self.shoot(browser, "zoomed")
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])

    def test_two_pages_at_once_and_reloads(self):
        self.view()
        pages = [self.open(), self.open()]
        for _ in range(10):
            pages[0].refresh()
        self.replace("radiance: 0.3", "radiance: 0.9")
        for page in pages:
            self.until(lambda: self.attribute(page, "done") == "true")
        self.until(lambda: self.mean(pages[0]) == self.mean(pages[1]))


if __name__ == "__main__":
    if webdriver is None or not CHROMIUM or not DRIVER:
        print("skipped: needs chromium, chromium-driver and python3-selenium")
        sys.exit(77)
    ProgramTest.PELAGE = sys.argv.pop(1)
    unittest.main()
