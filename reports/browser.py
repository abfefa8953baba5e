"""A headless Chromium that Selenium drives."""

import base64
import json
import os
import shutil
from pathlib import Path

try:
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.common.print_page_options import PrintOptions
except ImportError:
    webdriver = None

PROGRAM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
MISSING = "" if webdriver and PROGRAM and DRIVER else "install chromium-driver and python3-selenium: the page needs a browser"
FLAGS = ("--headless", "--disable-gpu", "--in-process-gpu", "--disable-extensions", "--disable-component-update",
         "--disable-dev-shm-usage")
A4 = {"page_width": 21.0, "page_height": 29.7}  # centimetres
MARGIN = 1.0  # centimetres


class BrowserError(RuntimeError):
    """The browser or the page reported an error."""


class Browser:
    """One page."""

    def __enter__(self):
        if MISSING:
            raise BrowserError(MISSING)
        options = webdriver.ChromeOptions()
        options.binary_location = PROGRAM
        for flag in (*FLAGS, *(["--no-sandbox"] if os.geteuid() == 0 else [])):  # the sandbox does not run as root
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        os.environ["NO_PROXY"] = os.environ["no_proxy"] = "localhost,127.0.0.1"  # the driver listens on this machine
        try:  # both programs are given by their paths, so that Selenium looks for none and downloads none
            self.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        except WebDriverException as error:
            raise BrowserError(f"{PROGRAM} does not start: {error.msg}") from None
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def open(self, file):
        """Opens a file and waits until it and its resources are loaded."""
        self.driver.get("about:blank")
        self.complaints(), self.requests()
        self.driver.get(Path(file).resolve().as_uri())

    def complaints(self):
        """Errors and warnings of the page since this was asked last."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]

    def requests(self):
        """Addresses that the page has loaded since the last call."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]

    def width(self, pixels, height=900):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": pixels, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def media(self, kind="screen", scheme="light"):
        """kind: screen or print; scheme: light or dark."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "media": kind, "features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def evaluate(self, script):
        """The value of an expression, of a promise when it is kept."""
        answer = self.driver.execute_cdp_cmd("Runtime.evaluate", {
            "expression": script, "returnByValue": True, "awaitPromise": True})
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise BrowserError(details.get("exception", {}).get("description") or details["text"])
        return answer["result"].get("value")

    def press(self, key):
        """Presses and releases a key, ENTER or SPACE, where the focus is."""
        ActionChains(self.driver).send_keys(getattr(Keys, key)).perform()

    def pdf(self, pages=()):
        """The page as it is printed, all of it or ranges as "2-5"."""
        options = PrintOptions()
        options.background = True
        for name, value in (*A4.items(), *((f"margin_{edge}", MARGIN) for edge in ("top", "bottom", "left", "right"))):
            setattr(options, name, value)
        options.page_ranges = list(pages)
        try:
            return base64.b64decode(self.driver.print_page(options))
        except WebDriverException as error:
            raise BrowserError(error.msg) from None
