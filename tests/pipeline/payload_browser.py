# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a page of hostile names in Chromium and uses all of it: payload_browser.py PAGE WORDS...

PAGE is ensemble.html, slides.html or comparison.html; each of WORDS is markup that it must say as text. Any fault ends
with an assertion that says what was seen.
"""
import pathlib
import sys

from selenium.webdriver.common.by import By

from browser import check_console, check_elements, check_policy, check_trouble, open_browser, open_page

# What names ask for and no page of ours holds, and pictures that are no data of its own.
FOREIGN = [
    "svg[onload]", "iframe", "object", "embed", "form", "base", "link", "[onerror]", "[onclick]", "[onload]",
    "img:not([src^='data:image/png;base64,'])",
]


def check_words(browser, words):
    """What a name says stands in the page, but for its blanks and the places where a line may break."""
    shown = browser.execute_script("return document.body.textContent + document.title").replace("\u200b", "")
    for text in words:
        assert " ".join(text.split()) in " ".join(shown.split()), f"the page does not say {text}"


def use_everything(browser):
    """Every choice, button, row and tooltip: what draws names draws them."""
    browser.execute_script("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    for choice in ("#quantities input", "#layers input", "#overlays input"):
        for place in range(len(browser.find_elements(By.CSS_SELECTOR, choice))):
            browser.execute_script("document.querySelectorAll(arguments[0])[arguments[1]].click()", choice, place)
    browser.execute_script(
        "for (const s of document.querySelectorAll('select')) for (const option of s.options) {"
        "  s.value = option.value; s.dispatchEvent(new Event('change', {bubbles: true})); }"
    )
    for place in range(len(browser.find_elements(By.CSS_SELECTOR, "#table tbody tr"))):
        browser.execute_script("document.querySelectorAll('#table tbody tr')[arguments[0]].click()", place)
    browser.execute_script("document.querySelectorAll('#table th button').forEach((b) => b.click())")
    chosen = browser.execute_script("return ensemble.selection.chosen")
    assert chosen is not None, "no row was chosen: this test looks at nothing"
    browser.execute_script("document.querySelectorAll('input[type=checkbox]').forEach((b) => b.click())")


def main():
    page, words = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    is_drawn = page.stem != "comparison"  # a comparison is a page without scripts
    browser = open_browser((1440, 1000))
    try:
        if is_drawn:
            open_page(browser, page)
        else:
            browser.get(f"file://{page}")
        scripts = browser.execute_script("return document.querySelectorAll('script').length")
        assert scripts == (4 if is_drawn else 0), f"{scripts} scripts"
        check_elements(browser, FOREIGN, scripts)
        check_policy(browser)
        if is_drawn:
            use_everything(browser)
            check_trouble(browser)
        check_words(browser, words)
        check_elements(browser, FOREIGN, scripts)
        check_console(browser, has_trouble=is_drawn)
    finally:
        browser.quit()


main()
