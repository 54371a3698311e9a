# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a report in Chromium and uses it as a person would: report_browser.py OUT clicks|prints|payload|accepted|flat.

OUT holds report.html and the maps it was made from. Any fault ends with an assertion that says what was seen.
"""
import base64
import math
import os
import sys
import time

import relief
from osgeo import gdal
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from browser import check_console, check_elements, check_policy, open_browser, open_page

gdal.UseExceptions()


def colours_of_map(browser):
    """Opaque colours of what lies on the ground, a few thousand pixels."""
    return browser.execute_script(
        "const c = report.map.canvas, d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        "const seen = new Set();"
        "for (let i = 0; i < d.length; i += 4 * 37) if (d[i + 3]) seen.add(d[i] + ',' + d[i + 1] + ',' + d[i + 2]);"
        "return [...seen];"
    )


def check_layers(browser):
    """Every layer can be chosen; each shows something, with a legend of its own."""
    seen = {}
    for button in browser.find_elements(By.CSS_SELECTOR, "#layers input"):
        name = button.get_attribute("value")
        button.find_element(By.XPATH, "..").click()
        assert button.is_selected(), f"{name} does not stay chosen"
        legend = browser.find_element(By.ID, "legend").text
        swatches = browser.find_elements(By.CSS_SELECTOR, "#legend li")
        if name == "none":
            assert not browser.execute_script("return report.map.thematic")
            continue
        assert swatches and legend, f"{name} has no legend"
        seen[name] = (legend, frozenset(colours_of_map(browser)))
        assert seen[name][1], f"{name} shows nothing"
    for name in [
        "deposit",
        "peak_thickness",
        "peak_speed",
        "peak_pressure",
        "arrival",
        "flow",
        "release",
        "surveyed",
        "difference",
    ]:
        assert name in seen, f"there is no layer {name}, but {list(seen)}"
    assert len({legend for legend, _ in seen.values()}) == len(seen), "two layers share a legend"
    assert seen["deposit"][1] != seen["peak_speed"][1], "two layers look the same"


def check_overlays(browser):
    def lines():
        return len(
            browser.find_elements(By.CSS_SELECTOR, "#map path.leaflet-interactive, #map .leaflet-overlay-pane path")
        )

    before = lines()
    box = browser.find_element(By.ID, "overlay-contours")
    box.click()
    assert lines() < before, "the contours do not go away"
    box.click()
    assert lines() == before, "the contours do not come back"


def check_player(browser):
    label = browser.find_element(By.ID, "time-label")
    browser.execute_script(
        "const s = document.getElementById('time'); s.value = 3; s.dispatchEvent(new Event('input'));"
    )
    assert label.text.startswith("t = 1.5"), f"the fourth of frames every 0.5 s is at {label.text}"
    assert browser.find_element(By.ID, "layer-flow").is_selected(), "the slider does not show the flow"
    third = frozenset(colours_of_map(browser))
    assert third, "the flow shows nothing"
    browser.find_element(By.ID, "play").click()
    WebDriverWait(browser, 10).until(lambda b: label.text.startswith("t = 3.0"))
    WebDriverWait(browser, 10).until(lambda b: b.execute_script("return !report.panel.timer"))


def geotiff(out, name):
    """f(x, y): the value of a map at a place, None where there is no data."""
    file = gdal.Open(f"{out}/maps/{name}.tif")
    west, dx, _, north, _, dy = file.GetGeoTransform()
    nodata, values = file.GetRasterBand(1).GetNoDataValue(), file.ReadAsArray()

    def value(x, y):
        found = float(values[int((y - north) / dy)][int((x - west) / dx)])
        return None if found == nodata else found

    return value, float(values.max())


def check_cursor(browser, out):
    """The value under the cursor is that of the GeoTIFF, within half a step of 1 / 65534 of its range."""
    area = browser.find_element(By.ID, "map")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", area)
    time.sleep(0.2)
    size, met = area.size, 0
    maps = {
        "deposit": "deposit_thickness",
        "peak_thickness": "peak_thickness",
        "peak_speed": "peak_speed",
        "arrival": "arrival_time",
    }
    for right, down in [(0.5, 0.5), (0.42, 0.52), (0.35, 0.5), (0.6, 0.45), (0.9, 0.9)]:
        ActionChains(browser).move_to_element_with_offset(
            area, round((right - 0.5) * size["width"]), round((down - 0.5) * size["height"])
        ).perform()
        place = browser.execute_script("return report.panel.place")
        assert place, "the map does not feel the cursor"
        for layer, name in maps.items():
            value, top = geotiff(out, name)
            shown = float(
                browser.find_element(By.CSS_SELECTOR, f"#cursor tr[data-id={layer}]").get_attribute("data-value")
            )
            stored = value(place["x"], place["y"])
            if stored is None:
                assert math.isnan(shown), f"{layer} at {place}: {shown}, but the file has no data"
            else:
                assert abs(shown - stored) <= top / 65534, f"{layer} at {place}: {shown}, but {stored} in the file"
                met += stored > 0
    assert met >= 6, f"only {met} values above 0 were met: this test looks at nothing"


def check_curves(browser):
    for name in [
        "profile-elevation",
        "profile-thickness",
        "series-energy",
        "series-speed",
        "series-motion",
        "series-front",
        "series-thickness",
        "series-mean-speed-over-depth",
        "series-elevation-of-the-surface",
    ]:
        drawn = browser.execute_script(
            "const c = document.getElementById(arguments[0]); if (!c) return -1;"
            "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;"
            "for (let i = 3; i < d.length; i += 4) n += d[i] > 0; return n;",
            name,
        )
        assert drawn > 500, f"the chart {name} is {'missing' if drawn < 0 else 'blank'}"
    chart = browser.find_element(By.ID, "profile-thickness")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", chart)
    time.sleep(0.2)
    ActionChains(browser).move_to_element(chart).perform()
    WebDriverWait(browser, 5).until(lambda b: b.execute_script("return !!report.map.marker._map"))


def check_scores(browser):
    """A score stands with its spread, and the spread nowhere by itself."""
    csi = browser.find_element(By.CSS_SELECTOR, "#score td[data-key=deposit_csi]").text
    assert " \u00b1 0.0" in csi and " to " in csi, f"the deposit's CSI has no spread: {csi}"
    alone = browser.find_elements(By.CSS_SELECTOR, "#score td[data-key$=_sd], #score td[data-key*=_p05]")
    assert not alone, f"a spread stands by itself: {[cell.get_attribute('data-key') for cell in alone]}"


def check_places(browser):
    """Both gauges are drawn and named on the map, can be switched off, and are listed with what they read."""
    names = [e.text for e in browser.find_elements(By.CSS_SELECTOR, "#map .leaflet-tooltip.place")]
    assert sorted(names) == ["below", "source"], f"the map names {names}"
    box = browser.find_element(By.ID, "overlay-places")
    box.click()
    WebDriverWait(browser, 5).until(
        lambda b: not b.find_elements(By.CSS_SELECTOR, "#map .leaflet-tooltip.place"), "the gauges do not go away"
    )
    box.click()
    rows = [row.text for row in browser.find_elements(By.CSS_SELECTOR, "#places tbody tr")]
    assert len(rows) == 2 and rows[0].startswith("source gauge") and "thickness 4." in rows[0], rows
    note = browser.find_element(By.ID, "series-note").text
    assert "records of the history" in note and "arrival times" in note, note


def check_surveys(browser):
    """Alignment, error and volumes of the two models that the scene was made from."""
    text = browser.find_element(By.ID, "surveys").text
    for words in ["the later model lay", "level of detection", "source, as surveyed"]:
        assert words in text, f"the comparison of the surveys does not say '{words}': {text}"


def check_parameters(browser):
    text = browser.find_element(By.ID, "parameters").text
    marked = [row.text for row in browser.find_elements(By.CSS_SELECTOR, "#parameters tr.changed")]
    assert any(
        row.startswith("base.friction_angle_deg 15.0") for row in marked
    ), f"the bed's friction is not marked: {marked}"
    assert "largest_step_s" not in text, "a parameter at its default stands among those that were changed"
    browser.find_element(By.ID, "all-parameters").click()
    assert "largest_step_s" in browser.find_element(By.ID, "parameters").text, "the other parameters do not come"


def check_screenshot(browser):
    """Not blank: many colours in what the eye sees."""
    browser.execute_script("scrollTo(0, 0)")
    picture = browser.get_screenshot_as_png()
    gdal.FileFromMemBuffer("/vsimem/shot.png", picture)
    pixels = gdal.Open("/vsimem/shot.png").ReadAsArray()[:3].reshape(3, -1)[:, ::17]
    colours = {tuple(p) for p in pixels.T.tolist()}
    assert len(colours) > 100, f"the screenshot has {len(colours)} colours"


def clicks(browser, out):
    check_screenshot(browser)
    check_layers(browser)
    check_overlays(browser)
    check_player(browser)
    check_cursor(browser, out)
    check_curves(browser)
    check_scores(browser)
    check_places(browser)
    check_surveys(browser)
    check_parameters(browser)
    relief.check(browser, out)
    check_console(browser)


def flat(browser, out):
    """Where the browser draws no WebGL, a line says so and the rest is whole."""
    relief.check_without(browser)
    check_layers(browser)
    check_console(browser)


def payload(browser, out):
    """Names that would run as scripts stand there as text, and the page holds no element that they ask for."""
    assert browser.execute_script("return window.pwned") is None, "a name ran as a script"
    title = os.environ["TITLE"]
    assert browser.execute_script("return document.getElementById('title').textContent") == title
    assert browser.title == " ".join(title.split()), f"the window is called {browser.title}"
    assert os.environ["INSTITUTION"] in browser.execute_script("return document.getElementById('byline').textContent")
    foreign = ["img", "svg[onload]", "iframe", "object", "embed", "form", "base", "link", "[onerror]", "[onclick]"]
    check_elements(browser, foreign, scripts=5)
    check_policy(browser)
    check_layers_and_console(browser)


def check_layers_and_console(browser):
    for button in browser.find_elements(By.CSS_SELECTOR, "#layers input"):
        button.find_element(By.XPATH, "..").click()
    assert browser.execute_script("return window.pwned") is None
    check_console(browser)


def accepted(browser, out):
    """What was insisted on is seen, with its words, among the findings."""
    text = browser.find_element(By.ID, "findings").text
    assert "swapped-surveys" in text and "mass goes down" in text, f"the findings do not say what was accepted: {text}"
    row = browser.find_element(By.CSS_SELECTOR, "#findings td[data-finding='swapped-surveys']")
    table = browser.find_element(By.CSS_SELECTOR, "#findings table")
    assert row.is_displayed() and table.size["width"] <= 1300, f"the table is {table.size['width']} wide"
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", row)
    browser.save_screenshot(f"{out}/accepted.png")
    check_console(browser)


def prints(browser, out):
    relief.check_printed(browser)
    pdf = browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True})
    with open(f"{out}/report.pdf", "wb") as file:
        file.write(base64.b64decode(pdf["data"]))
    check_console(browser)


def main():
    out, task = sys.argv[1:]
    browser = open_browser(webgl=task != "flat")
    try:
        open_page(browser, f"{out}/report.html")
        {"clicks": clicks, "prints": prints, "payload": payload, "accepted": accepted, "flat": flat}[task](browser, out)
    finally:
        browser.quit()


main()
