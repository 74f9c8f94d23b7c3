"""A report's page in a browser without a window (Debian's Chromium), beside the rows that it was made of."""

import pathlib
import tempfile
import unittest

import numpy
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

from host.lab.report import cards, charts, document, plots

# Name, area, wrong tests a million.
VARIANTS = [("binary32", 4000.0, 0.0), ("e8p20", 3000.0, 2.0), ("e8p16", 2000.0, 30.0), ("e8p12", 1000.0, 500.0), ("worse", 3500.0, 900.0)]
COSTS = {"area": "area", "period_ns": "period"}


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for word in ("--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,2400"):
            options.add_argument(word)
        cls.browser = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))
        cls.addClassCleanup(cls.browser.quit)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.frames = []
        for i, (name, area, wrong) in enumerate(VARIANTS):
            stem = cls.folder / name
            for file, shade in ((f"{stem}.png", i / 8), (f"{stem}-flip.png", 1 - i / 8)):
                plots.save_pixels(numpy.full((6, 8, 3), shade), pathlib.Path(file))
            cls.frames.append({"variant": name, "unit": "pipeline", "doubts": i == 0, "area": area, "period_ns": 10.0 - i, "wrong": wrong,
                               "picture": str(stem), "map": f"{stem}-flip.png"})
        charts.pareto(cls.frames, COSTS, "wrong", "wrong tests a million", "a scene", cls.folder / "pareto.png")
        text = "# A report\n\n" + document.table(cls.frames, "variant", "area :,.0f", "wrong :.0f") + (
            f"\n{document.CARDS}\n\n![pareto](pareto.png)\n")
        document.write(text, cls.folder, cards.of_scenes({"scene": cls.frames}))

    def setUp(self) -> None:
        self.browser.get(f"file://{self.folder}/report.html")
        self.wait(lambda b: b.execute_script("return document.documentElement.dataset.drawn"))

    def wait(self, what: object) -> None:
        """Until it is so."""
        WebDriverWait(self.browser, 60).until(what)

    def find(self, selector: str) -> list:
        """All that match."""
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def column(self, i: int) -> list[str]:
        """Of the table's rows that are seen."""
        return [row.find_elements(By.TAG_NAME, "td")[i].text for row in self.find(".wide tbody tr") if row.is_displayed()]

    def points(self) -> dict[str, object]:
        """Of the first panel, by variant."""
        marks = [mark for mark in self.find(".chart .mark-symbol path[aria-roledescription=point]")]
        return {mark.get_attribute("aria-label").split("variant: ")[1].split(";")[0]: mark for mark in reversed(marks)}

    def test_tables_sort_and_filter(self) -> None:
        self.assertEqual(self.column(0), [name for name, *_ in VARIANTS])
        area = self.find(".wide th")[1]
        area.click()
        self.assertEqual(self.column(1), ["1,000", "2,000", "3,000", "3,500", "4,000"])
        area.click()
        self.assertEqual(self.column(1), ["4,000", "3,500", "3,000", "2,000", "1,000"])
        self.assertEqual(area.get_attribute("aria-sort"), "descending")
        self.find("input.filter")[0].send_keys("P1")
        self.assertEqual(self.column(0), ["e8p16", "e8p12"])

    def test_a_point_says_what_it_is_and_shows_its_card(self) -> None:
        points = self.points()
        self.assertEqual(set(points), {name for name, *_ in VARIANTS})
        ActionChains(self.browser).move_to_element(points["e8p16"]).perform()
        self.wait(lambda _: self.find("#vg-tooltip-element.visible"))
        said = self.find("#vg-tooltip-element")[0].text
        for wanted in ("e8p16", "2,000", "30.0", "8.00", "doubts ignored"):
            self.assertIn(wanted, said)
        points["e8p12"].click()
        self.wait(lambda _: Select(self.find("#right")[0]).first_selected_option.text == "e8p12")
        self.assertIn("500.0", self.find("#figures")[0].text)

    def test_two_pictures_under_a_slider(self) -> None:
        self.assertEqual([option.text for option in Select(self.find("#left")[0]).options], [name for name, *_ in VARIANTS])
        Select(self.find("#left")[0]).select_by_visible_text("e8p20")
        Select(self.find("#right")[0]).select_by_visible_text("e8p16")
        under, over = self.find("#slide img")
        self.assertEqual([image.get_attribute("src") for image in (under, over)],
                         [document.inlined(self.folder / f"{name}.png") for name in ("e8p20", "e8p16")])
        self.browser.execute_script("const s = document.getElementById('split'); s.value = 25; s.dispatchEvent(new Event('input', {bubbles: true}))")
        self.assertEqual(over.value_of_css_property("clip-path"), "inset(0px 0px 0px 25%)")
        self.find("#differ")[0].click()
        self.assertEqual(over.get_attribute("src"), document.inlined(self.folder / "e8p16-flip.png"))
        rows = [row.text for row in self.find("#figures tr")]
        self.assertEqual(rows[:2], ["figure e8p20 e8p16", "area, um2 in OSU 0.35 um 3,000 2,000"])

    def test_dark_light_and_nothing_from_elsewhere(self) -> None:
        paper = self.browser.execute_script("return getComputedStyle(document.body).backgroundColor")
        self.find("#theme")[0].click()
        self.wait(lambda b: b.execute_script("return document.documentElement.dataset.drawn") == "dark")
        self.assertNotEqual(paper, self.browser.execute_script("return getComputedStyle(document.body).backgroundColor"))
        names = self.browser.execute_script("return performance.getEntriesByType('resource').map(e => e.name)")
        self.assertEqual([name for name in names if not name.startswith("data:")], [])
        self.assertEqual([entry for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"], [])


if __name__ == "__main__":
    unittest.main()
