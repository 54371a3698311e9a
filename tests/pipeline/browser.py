# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Debian's Chromium without a window, as the tests of pages drive it."""
import os

from selenium import webdriver
from selenium.webdriver.chrome.service import Service


def open_browser(size=(1300, 1000), webgl=True):
    """A browser whose console is kept; with WebGL by the processor, or with none at all."""
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    options.add_argument(f"--window-size={size[0]},{size[1]}")
    for argument in ["--headless=new", "--disable-gpu", "--disable-dev-shm-usage"]:
        options.add_argument(argument)
    options.add_argument("--enable-unsafe-swiftshader" if webgl else "--disable-3d-apis")
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")  # Chromium's sandbox refuses root, which tests in containers are
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    browser.set_script_timeout(120)  # WebGL by a processor that others use too
    return browser
