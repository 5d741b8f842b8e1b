#!/usr/bin/python3
"""Opens the pages of `fabrica validate` in a real browser without a display or a network and does what a reader does:
follows the index, hovers over a curve, zooms by dragging and goes back.

usage: pages_test.py FABRICA    (packages: chromium, chromium-driver, python3-selenium)
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

HERE = pathlib.Path(__file__).resolve().parent
FABRICA = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else None


def browser():
    options = webdriver.ChromeOptions()
    # no name can be resolved: whatever the page needs must lie beside it
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1200,1400",
                     "--host-resolver-rules=MAP * ~NOTFOUND", "--disable-dev-shm-usage"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        done = subprocess.run([FABRICA, "validate", "--cases", HERE / "cases", "--out", cls.out / "pages"],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        cls.driver = browser()

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.folder.cleanup()

    def setUp(self):
        self.driver.get((self.out / "pages" / "index.html").as_uri())
        self.driver.find_element(By.LINK_TEXT, "two-curves").click()
        self.wait(lambda d: d.find_elements(By.CSS_SELECTOR, "#signal1 .scatterlayer .trace path.js-line"))

    def wait(self, condition):
        return WebDriverWait(self.driver, 20).until(condition)

    def x_range(self):
        return self.driver.execute_script("return document.getElementById('signal1')._fullLayout.xaxis.range.slice()")

    def plot_area(self, chart):
        element = self.driver.find_element(By.CSS_SELECTOR, f"#{chart} .nsewdrag")
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        return element

    def test_text_of_the_case_is_there_and_escaped(self):
        heading = self.driver.find_element(By.TAG_NAME, "h1").text
        self.assertEqual(heading, "A half sine <beside> its reference, and a loop")
        text = self.driver.find_element(By.TAG_NAME, "body").text
        self.assertIn("closed form: 10 sin(pi t / 50)", text)
        self.assertIn("no reference curve available", text)
        notes = self.driver.find_element(By.CLASS_NAME, "notes")
        self.assertIn("a <b>loop</b> is drawn & not rated", notes.text)
        self.assertNotIn("Two curves", notes.text)  # the page has its own title
        self.assertEqual([c.text for c in notes.find_elements(By.TAG_NAME, "td")], ["half sine", "10 kN"])
        self.assertEqual([a.get_attribute("href") for a in notes.find_elements(By.TAG_NAME, "a")],
                         ["https://example.org/"])
        self.assertIn("see curves.csv", notes.text)
        self.assertIn("passed", text)
        self.assertIn("CORA 3.6", text)
        self.assertIn("ISO/TS 18571:2014", text)
        self.assertRegex(text, r"Published rating .* 0\.920")

    def test_curves_and_corridor_are_drawn(self):
        names = self.driver.execute_script("return document.getElementById('signal1').data.map(t => t.name)")
        self.assertEqual(names[-2:], ["model", "reference"])
        self.assertTrue(any("corridor" in n for n in names), names)
        fills = self.driver.find_elements(By.CSS_SELECTOR, "#signal1 .fills path.js-fill")
        self.assertGreaterEqual(len(fills), 1)

    def test_hover_shows_the_values_of_all_curves_at_one_time(self):
        area = self.plot_area("signal1")
        ActionChains(self.driver).move_to_element(area).perform()  # the middle: t = 25 ms, 10 kN and 9 kN
        text = self.wait(lambda d: d.find_element(By.CSS_SELECTOR, "#signal1 .hoverlayer").text)
        text = text.replace("\u2212", "-")
        self.assertRegex(text, r"model : (10|9\.9\d*)")
        self.assertRegex(text, r"reference : (9|8\.9\d*)")

    def test_hover_on_a_loop_shows_the_nearest_point(self):
        mode = self.driver.execute_script("return document.getElementById('signal2').layout.hovermode")
        self.assertEqual(mode, "closest")

    def test_dragging_zooms_and_a_double_click_goes_back(self):
        whole = self.x_range()
        area = self.plot_area("signal1")
        width = area.rect["width"]
        ActionChains(self.driver).move_to_element_with_offset(area, int(-0.25 * width), 0).click_and_hold() \
            .move_by_offset(int(0.25 * width), 2).move_by_offset(int(0.25 * width), 0).release().perform()
        self.wait(lambda d: self.x_range()[1] - self.x_range()[0] < 0.6 * (whole[1] - whole[0]))
        low, high = self.x_range()
        # the middle half of 0 to 50 ms
        self.assertAlmostEqual(low, 12.5, delta=2)
        self.assertAlmostEqual(high, 37.5, delta=2)
        ActionChains(self.driver).double_click(area).perform()
        self.wait(lambda d: abs(self.x_range()[0] - whole[0]) < 1e-9 and abs(self.x_range()[1] - whole[1]) < 1e-9)

    def test_nothing_is_missing_and_no_script_fails(self):
        severe = [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(severe, [])
        sources = self.driver.execute_script(
            "return [...document.querySelectorAll('[src], link[href]')].map(e => e.src || e.href)")
        self.assertTrue(sources)
        for source in sources:
            self.assertTrue(source.startswith("file:"), source)


if __name__ == "__main__":
    unittest.main(verbosity=2)
