# SPDX-License-Identifier: Apache-2.0
"""Lights that the page of `pelage view` draws over the picture, in a real browser."""
import math

try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    pass

from program_page import PageTest, run_tests

LIGHTS = """lights:
  key: {type: rectangle, position: [1, 1, 3], look_at: [0, 0, 0], size: [1, 1], intensity: 8}  # warm
  sky: {type: environment, radiance: 0.3}
"""


class Lights(PageTest):
    def light(self, name, block="lights"):
        return next((light for light in self.state()[block] if light["name"] == name), None)

    def place(self, browser, point):
        """Where a point of the scene is in the window of the browser."""
        return browser.execute_async_script("""
            const [point, done] = arguments, query = location.search;
            Promise.all([import("./light_shapes.js" + query), fetch("state.json" + query).then(answer => answer.json())]).then(
              ([shapes, state]) => {
                const canvas = document.getElementById("canvas"), box = canvas.getBoundingClientRect();
                const at = shapes.viewOf(state.camera, state.width, state.height).project(point);
                const scale = Math.min(box.width / state.width, box.height / state.height);
                done([(at[0] - state.width / 2) * scale, (at[1] - state.height / 2) * scale]);
              });""", point)

    def drag(self, browser, point, x, y, button=0):
        canvas = browser.find_element(By.ID, "canvas")
        at = self.place(browser, point)
        actions = webdriver.ActionChains(browser).move_to_element_with_offset(canvas, round(at[0]), round(at[1]))
        pointer = actions.w3c_actions.pointer_action
        pointer.pointer_down(button=button)
        for _ in range(4):
            pointer.move_by(x // 4, y // 4)
        pointer.pointer_up(button=button)
        actions.perform()
        self.until(lambda: self.attribute(browser, "light_waits") == "false")
        self.settle(browser)

    def test_moves_adds_removes_and_writes(self):
        self.replace("lights: {sky: {type: environment, radiance: 0.3}}", LIGHTS)
        self.view("--set", "image={width: 120, height: 80}", "--set", "render.samples=4")
        browser = self.open()
        self.settle(browser)
        self.assertEqual(self.light("sky")["values"], {})
        browser.find_element(By.ID, "lights_mode").click()
        self.shoot(browser, "lights")

        # The middle of the light moves parallel to the picture.
        before = self.light("key")["values"]
        self.drag(browser, before["position"], 40, -20)
        moved = self.light("key")
        self.assertTrue(moved["changed"])
        self.assertGreater(math.dist(moved["values"]["position"], before["position"]), 0.1)
        self.assertEqual(moved["values"]["look_at"], before["look_at"])
        self.assertEqual(self.attribute(browser, "light"), "key")
        self.shoot(browser, "light_moved")

        # The aim, and around the aim with the right button: the distance stays.
        self.drag(browser, before["look_at"], 20, 20)
        aimed = self.light("key")["values"]
        self.assertGreater(math.dist(aimed["look_at"], before["look_at"]), 0.05)
        self.drag(browser, [0, 0, 0], 60, 0, button=2)
        turned = self.light("key")["values"]
        self.assertGreater(math.dist(turned["position"], aimed["position"]), 0.1)
        self.assertAlmostEqual(math.dist(turned["position"], turned["look_at"]), math.dist(aimed["position"], aimed["look_at"]), 3)

        # A second light, and its size.
        Select(browser.find_element(By.ID, "rig_type")).select_by_visible_text("sphere")
        browser.find_element(By.ID, "rig_add").click()
        self.until(lambda: self.light("sphere") is not None and self.attribute(browser, "light") == "sphere")
        self.settle(browser)
        ball = self.light("sphere")["values"]
        camera = self.state()["camera"]
        axis = [a - b for a, b in zip(ball["position"], camera["position"])]
        edge = browser.execute_async_script("""
            const [light, camera, done] = arguments;
            import("./light_shapes.js" + location.search).then(
              shapes => done(shapes.shapeOf(light, camera).handles.find(handle => handle.key === "radius").point));""",
            {"type": "sphere", "values": ball}, camera)
        self.assertGreater(math.hypot(*axis), 0)
        self.drag(browser, edge, 20, 0)
        self.assertGreater(abs(self.light("sphere")["values"]["radius"][0] - ball["radius"][0]), 0.01 * ball["radius"][0])
        self.shoot(browser, "light_added")

        # Into the scene file: only these values change.
        wanted = self.light("key")["values"]
        browser.find_element(By.ID, "rig_text").click()
        self.until(lambda: "sphere: {type: sphere" in browser.execute_script("return document.getElementById('text').value"))
        self.shoot(browser, "light_text")
        browser.find_element(By.ID, "write_text").click()
        self.until(lambda: not self.state()["lights_changed"])
        self.settle(browser)
        text = (self.path / "scene.yaml").read_text()
        self.assertIn("# warm", text)
        self.assertIn("type: sphere", text)
        for a, b in zip(self.light("key")["values"]["position"], wanted["position"]):
            self.assertAlmostEqual(a, b, places=4)

        # Removed, and back again.
        browser.find_element(By.ID, "rig_remove").click()
        self.until(lambda: self.light("sphere") is None)
        browser.find_element(By.ID, "rig_reset").click()
        self.until(lambda: self.light("sphere") is not None)

        # A copy beside the first, which is taken back.
        self.settle(browser)
        Select(browser.find_element(By.ID, "rig_list")).select_by_visible_text("sphere (sphere)")
        browser.find_element(By.ID, "rig_copy").click()
        self.until(lambda: self.attribute(browser, "light") == "sphere_2")
        self.assertEqual(self.light("sphere_2")["values"]["radius"], self.light("sphere")["values"]["radius"])
        self.assertGreater(math.dist(self.light("sphere_2")["values"]["position"], self.light("sphere")["values"]["position"]), 0.1)
        browser.find_element(By.ID, "rig_undo").click()
        self.until(lambda: self.light("sphere_2") is None)

        # A magnet, moved, taken back in one step, and written.
        Select(browser.find_element(By.ID, "rig_type")).select_by_visible_text("rectangle magnet")
        browser.find_element(By.ID, "rig_add").click()
        self.until(lambda: self.attribute(browser, "light") == "magnet")
        self.settle(browser)
        window = self.light("magnet", "magnets")["values"]
        self.drag(browser, window["position"], 30, 0)
        self.assertGreater(math.dist(self.light("magnet", "magnets")["values"]["position"], window["position"]), 0.05)
        webdriver.ActionChains(browser).key_down(Keys.CONTROL).send_keys("z").key_up(Keys.CONTROL).perform()
        self.until(lambda: self.light("magnet", "magnets")["values"]["position"] == window["position"])
        self.settle(browser)
        self.shoot(browser, "magnet_added")
        browser.find_element(By.ID, "rig_text").click()
        self.until(lambda: "magnet: {type: rectangle" in browser.execute_script("return document.getElementById('text').value"))
        browser.find_element(By.ID, "write_text").click()
        self.until(lambda: not self.state()["lights_changed"])
        self.assertIn("\nmagnets:\n  magnet: {type: rectangle", (self.path / "scene.yaml").read_text())

        # Many bounces are previewed.
        browser.find_element(By.ID, "dual").click()
        self.until(lambda: self.state()["dual"])
        self.settle(browser)
        bad = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(bad, [])


if __name__ == "__main__":
    run_tests()
