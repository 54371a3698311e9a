# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Debian's Chromium without a window, as the tests of pages drive it."""
import os

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait


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


def open_page(browser, page):
    """A page of ours, once it has drawn itself; it shows no trouble."""
    browser.get(f"file://{page}")
    WebDriverWait(browser, 60, 0.1).until(
        lambda b: b.execute_script("return document.documentElement.dataset.ready === 'yes'")
        or b.find_element(By.ID, "trouble").is_displayed()
    )
    check_trouble(browser)
    kind = browser.find_element(By.CSS_SELECTOR, "header .kind").text
    assert kind and "@" not in kind, f"the page calls itself {kind}"


def check_trouble(browser):
    trouble = browser.find_element(By.ID, "trouble")
    assert not trouble.is_displayed(), trouble.text


def check_console(browser, has_trouble=True):
    """The browser complains of nothing, nothing came from outside, and the page, where it can, shows no trouble."""
    # "rendering" warns of reading pictures back, which the tests do and the pages do not.
    faults = [
        line
        for line in browser.get_log("browser")
        if line["level"] in ("SEVERE", "WARNING") and line["source"] != "rendering"
    ]
    assert not faults, f"the console says: {faults}"
    asked = browser.execute_script("return performance.getEntriesByType('resource').map((e) => e.name)")
    outside = [name for name in asked if not name.startswith(("data:", "blob:"))]
    assert not outside, f"the page asked for {outside}"
    if has_trouble:
        check_trouble(browser)


def check_elements(browser, foreign, scripts):
    """No name ran as a script, and the page holds no element that names may ask for, and so many scripts as its own."""
    assert browser.execute_script("return window.pwned") is None, "a name ran as a script"
    for kind in foreign:
        found = browser.execute_script("return document.querySelectorAll(arguments[0]).length", kind)
        assert found == 0, f"{found} elements {kind}"
    found = browser.execute_script("return document.querySelectorAll('script').length")
    assert found == scripts, f"{found} scripts instead of those of the page, {scripts}"


def check_policy(browser):
    """What is injected later does not run either."""
    browser.execute_script(
        "const s = document.createElement('script'); s.textContent = 'window.pwned = 2'; document.body.append(s);"
        "const b = document.createElement('b'); s.className = b.className = 'injected'; document.body.append(b);"
        "b.innerHTML = '<i style=\"color:red\" onclick=\"window.pwned = 3\">x</i>'; b.firstChild.click();"
    )
    assert browser.execute_script("return window.pwned") is None, "an inline script runs: the policy does not hold"
    styled = browser.execute_script("return getComputedStyle(document.querySelector('.injected > i')).color")
    assert styled != "rgb(255, 0, 0)", "an inline style holds"
    browser.execute_script("document.querySelectorAll('.injected').forEach((e) => e.remove())")
    browser.get_log("browser")  # the refusals of the two above


def at_width(browser, width, height=900):
    """The window of a screen, or below 500 pixels of a telephone."""
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500},
    )
