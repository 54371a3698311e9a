# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages at the widths of a desktop, a small laptop, a tablet and a phone, and on paper: page_widths.py PAGE...

Nothing may reach beyond the window, nor beyond what holds it. Beside each page its pages on paper are left as a PDF.
Any fault ends with an assertion that names the elements.
"""
import base64
import pathlib
import sys
import time

from browser import at_width, open_browser, open_page

WIDTHS = [1440, 1024, 768, 390]

# What is wider than its room, or lies beyond the window: [[what, text, by how many pixels], ...]. A box that scrolls
# counts as too narrow for what it holds; the map cuts its tiles off by itself.
TOO_WIDE = """
const width = document.documentElement.clientWidth, found = [];
const name = (e) => e.tagName.toLowerCase() + (e.id ? "#" + e.id : "") + (e.className?.baseVal === undefined &&
  e.className ? "." + String(e.className).split(" ").join(".") : "");
const tell = (e, by) => found.push([name(e), (e.textContent || "").trim().slice(0, 60), Math.round(by)]);
if (document.documentElement.scrollWidth > width) tell(document.documentElement,
  document.documentElement.scrollWidth - width);
for (const e of document.body.querySelectorAll("*")) {
  if (e.closest("#map") || e.closest(".inner-map") || e.closest("svg") || e.tagName === "SCRIPT") continue;
  const box = e.getBoundingClientRect(), style = getComputedStyle(e);
  if (!box.width || !box.height || style.visibility === "hidden") continue;
  if (box.right > width + 1 || box.left < -1) tell(e, Math.max(box.right - width, -box.left));
  if (style.display !== "inline" && e.clientWidth > 0 && e.scrollWidth > e.clientWidth + 1)
    tell(e, e.scrollWidth - e.clientWidth);
}
return found.slice(0, 20);
"""


def open_folds(browser):
    """What is folded away is looked at as well."""
    browser.execute_script("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    browser.execute_script("const b = document.getElementById('all-parameters'); if (b && !b.checked) b.click();")


def too_wide(browser, seconds=30):
    """What stays too wide once curves and the view in 3-D have followed the window, which takes them a moment."""
    end = time.monotonic() + seconds
    while (found := browser.execute_script(TOO_WIDE)) and time.monotonic() < end:
        time.sleep(0.5)
    return found


def look(browser, page):
    faults = []
    for width in WIDTHS:
        at_width(browser, width)
        if "report" in page.name:
            open_page(browser, page)
        else:
            browser.get(f"file://{page}")
        open_folds(browser)
        faults += [f"{width} px: {what} \"{text}\" by {by} px" for what, text, by in too_wide(browser)]
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    pdf = browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True})
    page.with_suffix(".pdf").write_bytes(base64.b64decode(pdf["data"]))
    assert not faults, f"{page.name} is too wide:\n" + "\n".join(faults)


def main():
    browser = open_browser()
    try:
        for word in sys.argv[1:]:
            look(browser, pathlib.Path(word).resolve())
    finally:
        browser.quit()


main()
