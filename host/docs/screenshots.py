"""`build/venv/bin/python3 host/docs/screenshots.py`: saves PNGs of --serve and `make page` for the tutorials in host/docs.

Requires `make verilate page`."""

import pathlib
import re
import signal
import subprocess
import tempfile

from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]


def save(browser: webdriver.Chrome, name: str) -> None:
    """Saves the window in 128 colours, which takes less than 200 kB."""
    with tempfile.TemporaryDirectory() as folder:
        whole = pathlib.Path(folder) / "whole.png"
        browser.save_screenshot(str(whole))
        Image.open(whole).convert("RGB").quantize(128, dither=Image.Dither.NONE).save(FOLDER / name, optimize=True)
    print(f"wrote host/docs/{name}")


def window(browser: webdriver.Chrome) -> None:
    """Saves the hit tests of an image."""
    browser.set_window_size(1100, 690)
    with subprocess.Popen(["./render", "scenes/still_life.json", "--engine", "cpu", "--size", "400x260", "--serve"],
                          cwd=ROOT, stdout=subprocess.PIPE, text=True) as server:
        browser.get(re.match(r"http://\S+", server.stdout.readline())[0])
        wait = WebDriverWait(browser, 120)
        Select(browser.find_element(By.NAME, "false-colour")).select_by_value("tests")
        wait.until(lambda b: "--false-colour" in b.find_element(By.ID, "command").text)
        wait.until(lambda b: b.find_element(By.ID, "said").text.startswith("400x260"))
        save(browser, "window.png")
        server.send_signal(signal.SIGINT)


def unit(browser: webdriver.Chrome) -> None:
    """Saves the paper's unit at one clock, with a broken gate in its adder."""
    browser.set_window_size(1100, 1000)
    browser.get((ROOT / "build/page/index.html").as_uri())
    WebDriverWait(browser, 60).until(lambda b: b.find_elements(By.CSS_SELECTOR, "[data-ready]"))
    browser.execute_script("document.getElementById('another').click();"
                           "const edge = document.getElementById('edge');"
                           "edge.value = 9; edge.dispatchEvent(new Event('input'))")
    save(browser, "unit.png")


def main() -> None:
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for word in ("--headless", "--no-sandbox", "--disable-gpu"):
        options.add_argument(word)
    browser = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))
    try:
        window(browser)
        unit(browser)
    finally:
        browser.quit()


if __name__ == "__main__":
    main()
