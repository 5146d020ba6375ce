# SPDX-License-Identifier: Apache-2.0
"""How tests open the page of `pelage view` in a real browser, driven by Selenium. They are skipped where Debian's chromium,
chromium-driver, python3-selenium or python3-numpy is missing; `./dev setup --browser` installs them. With PELAGE_SCREENSHOTS=DIR, keeps
pictures of the page."""
import json
import os
import pathlib
import shutil
import sys
import time
import unittest

try:
    import numpy
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
except ImportError:
    webdriver = None

from program_view import ProgramTest, ViewTest

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")


def run_tests():
    if webdriver is None or not CHROMIUM or not DRIVER:
        print("skipped: needs chromium, chromium-driver, python3-selenium and python3-numpy")
        sys.exit(77)
    ProgramTest.PELAGE = sys.argv.pop(1)
    unittest.main()


class PageTest(ViewTest):
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

    def until(self, holds, seconds=240):
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
        self.wait(lambda state: state["done"] and self.attribute(browser, "version") == state["version"] and
                  self.attribute(browser, "done") == "true")

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
