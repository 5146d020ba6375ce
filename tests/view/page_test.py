# SPDX-License-Identifier: Apache-2.0
"""The page of `pelage view` in a real browser."""
import json
import math
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


class Page(PageTest):
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

        # Closing the panel ends the mode, so that the camera gets its clicks back.
        browser.find_element(By.ID, "camera_mode").click()
        browser.find_element(By.ID, "why_mode").click()
        click()
        self.until(lambda: self.attribute(browser, "why"))
        self.shoot(browser, "why_and_camera")
        browser.find_element(By.ID, "why_close").click()
        self.assertEqual(browser.find_element(By.ID, "why_mode").get_attribute("aria-pressed"), "false")
        webdriver.ActionChains(browser).move_to_element(canvas).click_and_hold().move_by_offset(60, 0).release().perform()
        self.until(lambda: self.state()["camera"]["moved"])
        # So does a camera that is turned on.
        browser.find_element(By.ID, "camera_mode").click()
        browser.find_element(By.ID, "why_mode").click()
        browser.find_element(By.ID, "camera_mode").click()
        self.assertEqual(browser.find_element(By.ID, "why_mode").get_attribute("aria-pressed"), "false")
        browser.find_element(By.ID, "camera_reset").click()
        self.until(lambda: not self.state()["camera"]["moved"])
        browser.find_element(By.ID, "camera_mode").click()
        self.settle(browser)
        browser.find_element(By.ID, "why_mode").click()
        click()
        self.until(lambda: self.attribute(browser, "why"))

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

    def test_explains_the_picture_while_it_is_refined(self):
        self.view("--set", "image={width: 120, height: 80}", "--set", "render.samples=1000000")
        browser = self.open()
        browser.find_element(By.ID, "why_mode").click()
        webdriver.ActionChains(browser).move_to_element(browser.find_element(By.ID, "canvas")).click().perform()
        self.until(lambda: self.attribute(browser, "why"))
        self.assertFalse(self.state()["done"])
        self.assertIn("at rest", self.text(browser, "why_answer"))
        self.shoot(browser, "why_while_refining")

    def test_chooses_a_frame(self):
        self.view("--set", "image={width: 120, height: 80}", "--set", "frames=1-3",
                  "--set", "lights.sky.intensity={keys: {1: 0.2, 3: 6}}")
        browser = self.open()
        self.settle(browser)
        dark = self.mean(browser)[0]
        self.assertEqual(self.text(browser, "frame_number"), "1")
        # Play is the first thing that is done: so far, the scene has been read without a choice of a frame.
        play = browser.find_element(By.ID, "play")
        shows = lambda frame: self.state()["frame"] == 3 and self.text(browser, "frame_number") == str(frame)
        play.click()
        self.until(lambda: shows(2))
        play.click()
        self.until(lambda: self.text(browser, "frame_number") == str(self.state()["frame"]))
        browser.execute_script("const e = document.getElementById('frame'); e.value = 0; e.dispatchEvent(new Event('input'))")
        self.wait(lambda state: state["frame"] == 1)
        self.settle(browser)
        body = browser.find_element(By.TAG_NAME, "body")
        body.send_keys(".")
        body.send_keys(".")
        body.send_keys(".")
        self.wait(lambda state: state["frame"] == 3)
        self.settle(browser)
        self.until(lambda: self.mean(browser)[0] > dark + 20)
        self.until(lambda: self.text(browser, "frame_number") == "3")
        self.shoot(browser, "frame")
        browser.execute_script("const e = document.getElementById('frame'); e.value = 0; e.dispatchEvent(new Event('input'))")
        self.wait(lambda state: state["frame"] == 1)

        # Plays the frames without rendering them again.
        play.click()
        self.until(lambda: shows(2))
        self.until(lambda: shows(1))
        edits = self.state()["edits"]
        self.until(lambda: shows(3) and self.mean(browser)[0] > dark + 20)
        self.until(lambda: shows(1) and self.mean(browser)[0] < dark + 10)
        self.assertEqual(self.state()["edits"], edits)
        # An edit begins again.
        self.replace("radiance: 0.3", "radiance: 0.2")
        self.until(lambda: self.state()["edits"] >= edits + 3)
        self.until(lambda: shows(2))
        play.click()
        self.until(lambda: self.text(browser, "frame_number") == str(self.state()["frame"]))
        self.assertEqual(play.get_attribute("aria-pressed"), "false")

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
        # The canvas moves a little when the layers of the first pass appear.
        near = lambda again: again and max(abs(a - b) for a, b in zip(again, region)) <= 5
        self.until(lambda: near(self.state()["region"]))
        browser.find_element(By.TAG_NAME, "body").send_keys(Keys.ESCAPE)
        self.until(lambda: self.state()["region"] is None)

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
        self.until(lambda: self.text(pages[0], "shared") == "2 pages share one camera, region and frame")
        self.shoot(pages[0], "two_pages")
        pages[1].get("about:blank")
        self.until(lambda: self.text(pages[0], "shared") == "")


if __name__ == "__main__":
    run_tests()
