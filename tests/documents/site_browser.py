# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens the site of documents in Chromium from file:// and searches in it: site_browser.py HTML-FOLDER.

Any fault ends with an assertion that says what was seen.
"""
import os
import pathlib
import sys

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "pipeline"))
from browser import open_browser  # noqa: E402

# What is typed, and the page that has to be among what is found.
SEARCHES = {
    "velocity-weakening": "docs/how-to/",
    "youngs_modulus_Pa": "docs/reference/keys-solve.html",
    "checkpoint": "docs/reference/formats.html",
    "strength reduction": "docs/explanation/theory.html",
}


def found_by(browser, html, words):
    """Types `words` into the search field of the first page and gives the addresses of what is found."""
    browser.get(f"file://{html}/docs/index.html")
    field = browser.find_element(By.CSS_SELECTOR, "input[name=q]")
    field.send_keys(words, Keys.ENTER)
    WebDriverWait(browser, 60).until(lambda b: b.find_elements(By.CSS_SELECTOR, "ul.search li a"))
    WebDriverWait(browser, 60).until(
        lambda b: "Search Results" in b.find_element(By.ID, "search-results").text
        and "Searching" not in b.find_element(By.ID, "search-results").text)
    return [a.get_attribute("href") for a in browser.find_elements(By.CSS_SELECTOR, "ul.search li a")]


def check_result_opens(browser, html):
    """A click on the first result opens a page of the site with a heading."""
    browser.find_element(By.CSS_SELECTOR, "ul.search li a").click()
    WebDriverWait(browser, 60).until(lambda b: "search.html" not in b.current_url)
    assert browser.current_url.startswith(f"file://{html}/"), browser.current_url
    assert browser.find_element(By.CSS_SELECTOR, "h1").text, "the page that was found has no heading"


def check_first_page_leads_on(browser, html):
    browser.get(f"file://{html}/index.html")
    WebDriverWait(browser, 60).until(lambda b: b.current_url.endswith("/docs/index.html"))
    asked = browser.execute_script("return performance.getEntriesByType('resource').map((e) => e.name)")
    outside = [name for name in asked if not name.startswith((f"file://{html}/", "data:"))]
    assert not outside, f"the page asked for {outside}"


def check_pictures(browser, html):
    """Every picture of the page that has most of them is there."""
    for page in ("docs/index.html", "README.html"):
        browser.get(f"file://{html}/{page}")
        broken = browser.execute_script(
            "return [...document.images].filter((i) => i.complete && !i.naturalWidth).map((i) => i.src)")
        assert not broken, f"{page} shows no {broken}"


def main():
    html = os.path.abspath(sys.argv[1])
    browser = open_browser()
    try:
        check_first_page_leads_on(browser, html)
        for words, page in SEARCHES.items():
            found = found_by(browser, html, words)
            assert any(page in address for address in found), f"'{words}' finds {found}, and nothing of {page}"
            print(f"'{words}': {len(found)} pages")
        check_result_opens(browser, html)
        browser.get(f"file://{html}/search.html?q=zzyzxqwert")
        WebDriverWait(browser, 60).until(lambda b: "did not match" in b.find_element(By.ID, "search-results").text)
        check_pictures(browser, html)
    finally:
        browser.quit()


main()
