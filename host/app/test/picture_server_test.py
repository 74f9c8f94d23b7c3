"""Tests --serve by HTTP and in a headless browser (Debian's Chromium).

usage: RAYGATE_PROGRAM=build/render python3 -m unittest host/app/test/picture_server_test.py
"""

import http.client
import json
import os
import pathlib
import re
import resource
import shlex
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = pathlib.Path(os.environ.get("RAYGATE_PROGRAM", ROOT / "build" / "render")).resolve()
PAGE = ROOT / "host" / "app" / "picture_page.html"


class Served:
    """Context manager: ./render --serve of a scene, which ends with the `with` block."""

    def __init__(self, *arguments):
        self.arguments = [str(ROOT / "scenes" / "cornell.json"), "--engine=cpu", "--size", "64x48",
                          *arguments]

    def __enter__(self):
        self.process = subprocess.Popen([PROGRAM, *self.arguments, "--serve"], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        line = self.process.stdout.readline()
        self.address = re.match(r"http://127\.0\.0\.1:\d+", line)[0]
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.said = self.process.communicate(timeout=20)
        self.status = self.process.returncode

    def get(self, path, headers=None, **options):
        """Returns status, headers and bytes of the reply to `path` with the query `options`."""
        query = "?" + urllib.parse.urlencode(options) if options else ""
        request = urllib.request.Request(self.address + path + query, headers=headers or {})
        try:
            with urllib.request.urlopen(request, timeout=60) as reply:
                return reply.status, reply.headers, reply.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read()


class Http(unittest.TestCase):
    def test_pictures_are_those_of_the_command(self):
        with Served("--spp", "2", "--seed=7") as served:
            for options in ({}, {"spp": 1, "size": "31x17"}, {"view": "30,20"},
                            {"camera": "278,273,1300,100,300,0,30", "up": "y", "engine": "model"},
                            {"engine": "model", "variant": "e8p9-raw"}, {"false-colour": "Z=it's.png"}, {"integrator": "path", "exposure": 1}):
                with self.subTest(options), tempfile.TemporaryDirectory() as folder:
                    status, headers, picture = served.get("/picture", **options)
                    self.assertEqual(status, 200, picture)
                    words = shlex.split(headers["X-Command"])
                    self.assertEqual(words[0], "./render")
                    out = [] if "false-colour" in options else ["-o", "picture.png"]
                    subprocess.run([PROGRAM, *words[1:], *out, "-q"], cwd=folder, check=True)
                    name = options.get("false-colour", "=picture.png").split("=")[1]
                    self.assertEqual(picture, (pathlib.Path(folder) / name).read_bytes())
                    self.assertGreater(json.loads(headers["X-Statistics"])["rays"], 0)
        self.assertEqual((served.status, served.said[1]), (0, ""))

    def test_a_ground_stays_where_it_was(self):
        with tempfile.TemporaryDirectory() as folder:
            box = pathlib.Path(folder) / "box.obj"
            box.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
            run = Served()
            run.arguments[0] = str(box)
            with run as served:
                for options in ({}, {"camera": "4,3,5,0,0,0"}):
                    status, headers, picture = served.get("/picture", **options)
                    self.assertIn("--ground=on", headers["X-Command"])
                    subprocess.run([PROGRAM, *shlex.split(headers["X-Command"])[1:], "-o", "a.png",
                                    "-q"], cwd=folder, check=True)
                    self.assertEqual(picture, (pathlib.Path(folder) / "a.png").read_bytes())

    def test_what_is_wrong_is_one_line(self):
        with Served() as served:
            for path, options, said in (
                    ("/picture", {"width": 3}, "unknown option"),
                    ("/picture", {f"option{n}": n for n in range(65)}, "more than 64 parameters"),
                    ("/picture", {"output": "a.png"}, "unknown option"),
                    ("/picture", {"size": "3"}, "--size: found '3', expected WIDTHxHEIGHT"),
                    ("/picture", {"size": "5000x5000"}, "--size: expected at most 16777216 pixels"),
                    ("/picture", {"spp": 100000}, "--spp: expected at most 65536"),
                    ("/picture", {"slot": "left"}, "unknown option"),
                    ("/picture", {"false-colour": "nothing=a.png"}, "nothing"),
                    ("/picture", {"variant": "e8p9-raw"}, "--engine: found 'cpu', expected model with --variant e8p9-raw")):
                status, _, text = served.get(path, **options)
                self.assertEqual(status, 400)
                self.assertIn(said, text.decode())
                self.assertEqual(text.count(b"\n"), 1)
            status, _, text = served.get("/picture", headers={"Host": "elsewhere.example"})
            self.assertEqual(status, 403)

    @unittest.skipIf("sanitize" in str(PROGRAM), "the address sanitizer takes memory, too")
    def test_no_thread_is_free(self):
        with Served("--threads=1") as served:
            pid = served.process.pid
            pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[0])
            # Leave less memory than a new thread's stack needs.
            resource.prlimit(pid, resource.RLIMIT_AS, (pages * resource.getpagesize() + 2**20, resource.RLIM_INFINITY))
            self.assertEqual(served.get("/camera")[0], 500)
            resource.prlimit(pid, resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
            self.assertEqual(served.get("/camera")[0], 200)
        self.assertEqual((served.status, served.said[1]), (0, ""))

    def test_other_sites_and_methods_are_refused(self):
        with Served() as served:
            host = served.address.removeprefix("http://")
            for method, headers, expected in (
                    ("GET", {"Origin": "http://elsewhere.example"}, 403),
                    ("GET", {"Origin": "null"}, 403),
                    ("GET", {"Sec-Fetch-Site": "cross-site"}, 403),
                    ("GET", {"Sec-Fetch-Site": "same-site"}, 403),
                    ("GET", {"Sec-Fetch-Site": "same-origin", "Origin": served.address}, 200),
                    ("PUT", {}, 403), ("DELETE", {}, 403), ("POST", {}, 403)):
                with self.subTest(method=method, headers=headers):
                    connection = http.client.HTTPConnection(host, timeout=30)
                    connection.request(method, "/camera", headers=headers)
                    self.assertEqual(connection.getresponse().status, expected)
                    connection.close()
            with socket.create_connection(host.split(":"), timeout=30) as plain:
                plain.sendall(f"HEAD / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode())
                self.assertTrue(plain.makefile("rb").read().endswith(b"\r\n\r\n"), "without a body")

    def test_a_picture_ends_with_its_connection(self):
        with Served() as served:
            host = served.address.removeprefix("http://")
            with socket.create_connection(host.split(":"), timeout=30) as left:
                left.sendall(f"GET /picture?spp=60000&size=640x480 HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
                time.sleep(0.5)
            self.assertEqual(served.get("/picture", spp=1)[0], 200)

    def test_connections_that_say_nothing_block_nobody(self):
        with Served() as served:
            host = served.address.removeprefix("http://").split(":")
            silent = [socket.create_connection(host, timeout=30) for _ in range(20)]
            begin = time.monotonic()
            self.assertEqual(served.get("/camera")[0], 200)
            self.assertLess(time.monotonic() - begin, 15)
            for connection in silent:
                connection.close()

    def test_command_lines_that_are_refused(self):
        with Served() as served:
            port = served.address.rpartition(":")[2]
            for words, said in ((["--serve", "--port", port], f"--port: found {port}, expected a port"),
                                (["--port", port], "--port: expected with --serve"),
                                (["--serve", "--crop", "0,0,8,8"], "--crop and --serve exclude")):
                run = subprocess.run([PROGRAM, *served.arguments, *words], capture_output=True,
                                     text=True, check=False, timeout=60)
                self.assertEqual(run.returncode, 2)
                self.assertIn(said, run.stderr)

    def test_all_choices_of_the_page_are_options(self):
        with Served("--spp", "1") as served:
            selects = re.findall(r'<select name="([\w-]+)">(.*?)</select>', PAGE.read_text())
            self.assertGreater(len(selects), 4)
            for name, choices in selects:
                for value, text in re.findall(r'<option(?: value="([^"]*)")?>([^<]*)', choices):
                    value = value or text
                    if value in ("as started", "the picture"):
                        continue
                    if name == "false-colour":
                        value += "=a.png"
                    status, _, text = served.get("/camera", **{name: value})
                    self.assertEqual(status, 200, text)


class Browser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for word in ("--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,900"):
            options.add_argument(word)
        cls.browser = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def wait(self, what):
        WebDriverWait(self.browser, 60).until(what)

    def wait_drawn(self):
        """Waits until the last, full-size pass is drawn."""
        self.wait(lambda b: b.find_element(By.ID, "said").text.startswith("64x48"))

    def command(self):
        return self.browser.find_element(By.ID, "command").text

    def pixels(self):
        return self.browser.execute_script(
            "const c = document.getElementById('canvas');"
            "return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]")

    def test_the_page(self):
        with Served("--spp", "1") as served:
            browser = self.browser
            browser.get(served.address)
            self.wait_drawn()
            self.assertGreater(max(self.pixels()[:-1:4]), 100)
            frame = browser.find_element(By.ID, "frame")

            # After turning, zooming and moving, the command has a camera, and the picture differs. Fast wheel events cancel pictures.
            before = self.pixels()
            ActionChains(browser).drag_and_drop_by_offset(frame, 60, 10).perform()
            self.wait(lambda _: "--camera=" in self.command())
            self.wait_drawn()
            self.assertNotEqual(before, self.pixels())
            turned = self.command()
            browser.execute_script("for (let i = 0; i < 20; ++i)"
                                   "  arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: 1}))", frame)
            self.wait(lambda _: self.command() != turned)
            self.wait_drawn()
            browser.find_element(By.ID, "home").click()
            self.wait(lambda _: "--camera=" not in self.command())
            self.wait_drawn()
            self.assertEqual(before, self.pixels())

            # Another engine gives the same picture.
            Select(browser.find_element(By.NAME, "engine")).select_by_visible_text("model")
            self.wait(lambda _: "--engine=model" in self.command())
            self.wait_drawn()
            self.assertEqual(before, self.pixels())

            # The page sends requests to its server only.
            names = browser.execute_script("return performance.getEntriesByType('resource').map(e => e.name)")
            self.assertTrue(names)
            self.assertTrue(all(name.startswith(served.address) for name in names), names)

            # The page shows the program's message about a bad value.
            browser.find_element(By.NAME, "exposure").send_keys("e9\t")
            self.assertFalse([entry for entry in browser.get_log("browser")
                              if entry["level"] == "SEVERE" and "400" not in entry["message"]])


if __name__ == "__main__":
    unittest.main()
