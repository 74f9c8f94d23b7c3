"""Tests the page of `make page` in Chromium: compares it with build/sim/worked_example, which shares only the RTL with the page.

usage: python3 -m unittest sim/page/test/page_test.py, after `make page`"""

import pathlib
import re
import struct
import subprocess
import unittest

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAGE = ROOT / "build" / "page" / "index.html"


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for word in ("--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,1000"):
            options.add_argument(word)
        cls.browser = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def setUp(self):
        self.browser.get(PAGE.as_uri())
        WebDriverWait(self.browser, 60).until(lambda b: b.find_elements(By.CSS_SELECTOR, "[data-ready]"))

    def click(self, name):
        self.browser.execute_script("document.getElementById(arguments[0]).click()", name)

    def rows(self):
        """Returns the table's cells, by clock edge."""
        return self.browser.execute_script(
            "return [...document.querySelectorAll('#table tbody tr')].map(r => [...r.cells].map(c => c.textContent))")

    def wrong(self):
        return len(self.browser.find_elements(By.CSS_SELECTOR, "#table .wrong"))

    def test_words_are_those_of_the_worked_example(self):
        said = subprocess.run([ROOT / "build" / "sim" / "worked_example"], capture_output=True, text=True, check=True).stdout
        edges = [line.split() for line in said.splitlines() if re.match(r" +\d+ ", line)]
        self.assertEqual((len(edges), sum(edge.count("-") for edge in edges)), (10, 27))
        for row, expected in zip(self.rows(), edges):
            edge, *rest = expected
            name = rest.pop(0) if int(edge) <= 7 else ""
            # The program prints I-1, I-2, I-3, then the page's other columns; "-" for a word that is not of the example.
            first, second, third, *others = rest[:7]
            self.assertEqual(row[:2], [edge, name])
            for found, word in zip(row[2:9], [third, second, first, *others], strict=True):
                self.assertIn(word, (found, "-"), f"edge {edge}")
            self.assertEqual(row[9:], rest[7:] or [""])
        self.assertEqual(self.wrong(), 0)

    def test_a_broken_gate_shows(self):
        sound = self.rows()
        self.click("another")
        self.assertGreater(self.wrong(), 0)
        self.assertNotEqual([row[9] for row in self.rows()], [row[9] for row in sound])
        self.assertRegex(self.browser.find_element(By.ID, "fault-text").text, r"(inverted|held at [01]) \(hw/\w+/\w+\.sv:\d+\)")
        self.assertIn("where the sound adder gives", self.browser.find_element(By.ID, "point").text)
        self.click("mend")
        self.assertEqual((self.wrong(), self.rows()), (0, sound))

    def test_a_ray_and_a_triangle(self):
        self.click("aim")
        z = struct.unpack(">f", bytes.fromhex(self.rows()[9][9]))[0]
        x, y = (struct.unpack(">f", bytes.fromhex(self.rows()[k][9]))[0] for k in (7, 8))
        # The point is on the plane through (-1, -1, 0), (2, -1, 0.5), (0, 2, 0), and on the ray from (0, 0, 5) along (0.1, 0.2, -1).
        self.assertAlmostEqual(x / z, -0.1, 6)
        self.assertAlmostEqual(y / z, -0.2, 6)
        self.assertAlmostEqual(-1.5 * (x + 1) + 0.5 * (y + 1) + 9 * (z + 5), 0, 4)

    def test_a_wrong_field_says_what_is_expected(self):
        example = self.browser.find_element(By.ID, "point").text
        for field, value, said in (("N", "1, 2", 'N: found "1, 2", expected 3 numbers'), ("I", "1, 2,", 'I: found "1, 2,", expected 3 numbers'),
                                   ("d", "x", 'd: found "x", expected 1 number'), ("C", "0", 'corner C: found "0", expected 3 numbers')):
            self.browser.execute_script("form[arguments[0]].value = arguments[1]; $('form').dispatchEvent(new Event('input'))", field, value)
            self.click("aim" if field == "C" else "another")
            self.assertEqual(self.browser.find_element(By.ID, "point").text, said)
            self.click("example")
            self.assertEqual(self.browser.find_element(By.ID, "point").text, example)

    def test_the_registers_move(self):
        values = []
        for _ in range(10):
            self.click("on")
            values.append(self.browser.execute_script("return [...document.querySelectorAll('svg .word')].map(t => t.textContent)"))
        self.assertEqual([value[5] for value in values], [row[7] for row in self.rows()])
        self.assertEqual([value[0] for value in values], [row[5] for row in self.rows()])
        self.assertEqual(self.browser.execute_script("return performance.getEntriesByType('resource').length"), 0)

    def test_it_is_small(self):
        self.assertLess(PAGE.stat().st_size, 5_000_000)


if __name__ == "__main__":
    unittest.main()
