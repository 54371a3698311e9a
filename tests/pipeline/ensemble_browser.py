# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens the page of an ensemble or of many slides in Chromium and uses it as a person would: ensemble_browser.py PAGE.

Beside PAGE (ensemble.html or slides.html) lie members.csv, sensitivity.csv and probability/, or slides.csv. Any fault
ends with an assertion that says what was seen.
"""
import csv
import pathlib
import re
import sys

from osgeo import gdal
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

from browser import at_width, check_console, open_browser, open_page

gdal.UseExceptions()


def painted(browser):
    """How many pixels of the map's layer are coloured."""
    return browser.execute_script(
        "if (!ensemble.map.thematic) return 0;"
        "const c = ensemble.map.canvas, d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        "let n = 0; for (let i = 3; i < d.length; i += 4) if (d[i]) ++n; return n;"
    )


def choose(browser, box, value):
    label = browser.execute_script(
        "const label = document.querySelector(arguments[0]).parentElement;"
        "label.scrollIntoView({block: 'center'}); return label;",
        f"#{box} input[value='{value}']",
    )
    label.click()
    checked = browser.execute_script("return arguments[0].querySelector('input').checked", label)
    assert checked, f"{value} does not stay chosen"


def check_layers(browser):
    """Every layer of every quantity can be chosen and shows something, with a legend of its own."""
    quantities = browser.find_elements(By.CSS_SELECTOR, "#quantities input")
    assert len(quantities) == 5, f"{len(quantities)} quantities"
    for quantity in [button.get_attribute("value") for button in quantities]:
        choose(browser, "quantities", quantity)
        names = [b.get_attribute("value") for b in browser.find_elements(By.CSS_SELECTOR, "#layers input")]
        for name in names:
            choose(browser, "layers", name)
            legend = browser.find_element(By.ID, "legend").text
            assert "undefined" not in legend and "NaN" not in legend, f"{quantity}, {name}: {legend}"
            if name not in ("none", "hazard") and "q05" not in name:
                assert painted(browser) > 0, f"{quantity}, {name}: nothing is painted"
    check_console(browser)


def slide_to(browser, place):
    browser.execute_script(
        "const s = document.getElementById('threshold'); s.value = arguments[0];"
        "s.dispatchEvent(new Event('input', {bubbles: true}));",
        place,
    )


def check_slider(browser, out):
    """Each threshold shows the map of the file of its name, and a higher one never more."""
    choose(browser, "quantities", "peak_thickness")
    choose(browser, "layers", "share")
    before = None
    for place, threshold in enumerate(["0.1", "0.5", "1", "2", "5"]):
        slide_to(browser, place)
        label = browser.find_element(By.ID, "threshold-label").text
        assert label == f"{threshold} m or more", label
        share = gdal.Open(f"{out}/probability/peak_thickness_above_{threshold}_m.tif")
        west, cell, _, north, _, _ = share.GetGeoTransform()
        values = share.ReadAsArray()
        shown = painted(browser)
        assert before is None or shown <= before, f"{shown} pixels at {label}, {before} at the one below"
        before = shown
        cells = [(r, c) for r in range(0, values.shape[0], 3) for c in range(0, values.shape[1], 3)]
        at = [(west + (c + 0.5) * cell, north - (r + 0.5) * cell) for r, c in cells]
        look = "const field = ensemble.panel.share().field; return arguments[0].map(([x, y]) => field.at(x, y));"
        for spot, value, seen in zip(at, (values[cell] for cell in cells), browser.execute_script(look, at)):
            if seen is not None and value >= 0:  # within the window that is shown
                assert abs(seen - value) < 1e-4, f"{seen} at {spot} instead of {value}"
    # A map that is painted anew stays below the outlines.
    level = "return Number(getComputedStyle(arguments[0].closest('.leaflet-pane')).zIndex)"
    painted_at, drawn_at = (
        browser.execute_script(level, browser.execute_script(f"return ensemble.{what}"))
        for what in ("map.thematic._image", "outlines.renderer._container")
    )
    assert painted_at < drawn_at, f"the map at {painted_at} covers the outlines at {drawn_at}"


def click_at(browser, canvas, x, y):
    """Clicks a place of a canvas, in its own pixels."""
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    size = canvas.size
    offset = round(x - size["width"] / 2), round(y - size["height"] / 2)
    ActionChains(browser).move_to_element_with_offset(canvas, *offset).click().perform()


def chosen_after(browser, before):
    """The member that is chosen once it is another one than before; charts answer a frame later."""
    WebDriverWait(browser, 5).until(lambda b: b.execute_script("return ensemble.selection.chosen") != before)
    return browser.execute_script("return ensemble.selection.chosen")


def outline_points(browser):
    """How many lines are drawn bold on the map."""
    return browser.execute_script("return ensemble.outlines.bold.getLayers().length")


def check_choosing(browser, rows):
    """A click in scatter, parallel coordinates and table chooses a member, whose outline and numbers are shown."""
    assert outline_points(browser) == 0
    counted = [int(row["member"]) for row in rows if row["state"] == "counted"]
    canvas = browser.find_element(By.ID, "scatter")
    x, y, member = browser.execute_script(
        "const m = ensemble.scatter.chart.getDatasetMeta(1), p = m.data[3];"
        "return [p.x, p.y, ensemble.scatter.chart.data.datasets[1].data[3].member];"
    )
    click_at(browser, canvas, x, y)
    chosen = chosen_after(browser, None)
    assert chosen is not None and chosen in counted, f"a click on the point of member {member} chose {chosen}"
    assert outline_points(browser) >= 2, "its outline is not on the map"
    text = browser.find_element(By.ID, "chosen").text
    assert f"Member {chosen}" in text and "run-out" in text, text
    canvas = browser.find_element(By.CSS_SELECTOR, "#parallel canvas")
    wanted = next(k for k in counted if k != chosen)
    (x0, y0), (x1, y1) = browser.execute_script(f"return ensemble.parallel.line({wanted}).slice(0, 2)")
    click_at(browser, canvas, x0 + 0.37 * (x1 - x0), y0 + 0.37 * (y1 - y0))
    seen = chosen_after(browser, chosen)
    assert seen is not None, f"the click on a line of the parallel coordinates chose {seen}"
    shown = browser.find_elements(By.CSS_SELECTOR, "#table tbody tr:not(.failed):not(.chosen)")
    row, member = shown[-1], shown[-1].get_attribute("data-member")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", row)
    row.click()
    assert browser.execute_script("return ensemble.selection.chosen") == int(member)
    row = browser.find_element(By.CSS_SELECTOR, "#table tr.chosen")
    assert row.get_attribute("data-member") == member
    check_console(browser)


def check_medoids(browser):
    """A click on a member that stands for others chooses it."""
    button = browser.find_element(By.CSS_SELECTOR, "#medoids button")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
    button.click()
    member = int(button.get_attribute("data-member"))
    assert browser.execute_script("return ensemble.selection.chosen") == member
    assert outline_points(browser) >= 2, "its outline is not on the map"


def check_keeping(browser):
    """Dragging along an axis keeps some of the members, on the map too."""
    canvas = browser.find_element(By.CSS_SELECTOR, "#parallel canvas")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    everyone = browser.execute_script("return ensemble.outlines.drawn")
    x, size = browser.execute_script("return ensemble.parallel.x(0)"), canvas.size
    start = ActionChains(browser).move_to_element_with_offset(canvas, round(x - size["width"] / 2), -40)
    start.click_and_hold().move_by_offset(0, 70).release().perform()
    kept = browser.execute_script("return ensemble.selection.kept().length")
    drawn = browser.execute_script("return ensemble.outlines.drawn")
    assert 0 < drawn < everyone, f"{drawn} of {everyone} outlines after dragging along an axis"
    assert drawn <= kept, f"{drawn} outlines of {kept} members kept"
    browser.find_element(By.ID, "clear").click()
    assert browser.execute_script("return ensemble.outlines.drawn") == everyone


def check_sorting(browser, rows):
    heading = browser.find_element(By.XPATH, "//div[@id='table']//th/button[contains(., 'run-out')]")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", heading)
    known = sorted(float(row["run_out_m"]) for row in rows if row["run_out_m"])
    for order in (known, known[::-1]):
        heading.click()
        members = [
            int(row.get_attribute("data-member")) for row in browser.find_elements(By.CSS_SELECTOR, "#table tbody tr")
        ]
        shown = [float(rows[k]["run_out_m"]) for k in members if rows[k]["run_out_m"]]
        assert shown == order[: len(shown)], f"sorted by run-out: {shown[:5]} instead of {order[:5]}"


def check_sensitivity(browser, out):
    with open(f"{out}/sensitivity.csv", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["key"]]
    select = Select(browser.find_element(By.ID, "sensitivity-of"))
    for option in select.options:
        name = option.get_attribute("value")
        option.click()
        shown = browser.execute_script("return ensemble.sensitivity.chart.data.datasets.map((d) => d.data)")
        expected = [float(row["value"]) for row in rows if row["result"] == name]
        assert sorted(v for list in shown for v in list) and len(sum(shown, [])) == len(expected), f"{name}: {shown}"
        for a, b in zip(sorted(sum(shown, [])), sorted(expected)):
            assert abs(a - b) < 1e-4 * max(1, abs(b)), f"{name}: {a} is shown, {b} in sensitivity.csv"


def check_convergence(browser, rows):
    Select(browser.find_element(By.ID, "convergence-of")).select_by_value("run_out_m")
    known = [float(row["run_out_m"]) for row in rows if row["run_out_m"]]
    last = browser.execute_script("return ensemble.convergence.chart.data.datasets[0].data.at(-1)")
    assert last["x"] == len(known), last
    assert abs(last["y"] - sum(known) / len(known)) < 1e-4 * abs(last["y"]), last


def check_slides(browser):
    """Layers of slides have no threshold to choose, and nothing of a probability is said of them."""
    for quantity in [b.get_attribute("value") for b in browser.find_elements(By.CSS_SELECTOR, "#quantities input")]:
        choose(browser, "quantities", quantity)
        for name in [b.get_attribute("value") for b in browser.find_elements(By.CSS_SELECTOR, "#layers input")]:
            choose(browser, "layers", name)
            slider = browser.find_element(By.ID, "threshold")
            assert not slider.is_displayed(), f"{quantity}, {name}: a slider of nothing"
    text = browser.find_element(By.ID, "method").text
    assert "They are no probability" in text and "Hazard class" not in text, text


def check_widths(browser, page):
    """Nothing is wider than the window, at the widths of a screen, a tablet and a telephone."""
    for width in (1440, 768, 390):
        at_width(browser, width, 1000)
        open_page(browser, page)
        wide = browser.execute_script("return document.documentElement.scrollWidth")
        assert wide <= width, f"the page is {wide} wide in a window of {width}"
        wider = browser.execute_script(
            "return [...document.querySelectorAll('main *')].filter((e) => !e.closest('.scroll, #parallel, #map') &&"
            "e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.tagName + '#' + e.id + '.' + e.className)"
        )
        assert not wider, f"at {width}: {wider[:5]} reach beyond the window"
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def check_numbers(browser):
    """Numbers are as long as people read them: no more than five decimals in a row of the table or a key number."""
    for box in ("key-numbers", "table"):
        text = browser.find_element(By.ID, box).text
        assert not re.search(r"[1-9][0-9]*\.[0-9]{5}|0\.0*[1-9][0-9]{4}|NaN|undefined", text), f"{box}: {text}"


def check_ensemble(browser, out):
    with open(out / "members.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    check_layers(browser)
    check_slider(browser, out)
    check_choosing(browser, rows)
    check_medoids(browser)
    check_keeping(browser)
    check_sorting(browser, rows)
    check_sensitivity(browser, out)
    check_convergence(browser, rows)


def main():
    page = pathlib.Path(sys.argv[1]).resolve()
    browser = open_browser((1440, 1000))
    try:
        open_page(browser, page)
        check_numbers(browser)
        if page.stem == "slides":
            check_slides(browser)
        else:
            check_ensemble(browser, page.parent)
        check_console(browser)
        check_widths(browser, page)
    finally:
        browser.quit()


main()
