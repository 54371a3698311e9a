# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's view in 3-D in a browser that draws WebGL by its processor, and in one that draws none."""
import base64

from osgeo import gdal
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait


def seen(browser):
    """Pixels of the view, [3][rows][columns]."""
    picture = browser.execute_script("return report.relief.scene.picture()")
    gdal.FileFromMemBuffer("/vsimem/relief.png", base64.b64decode(picture.split(",")[1]))
    return gdal.Open("/vsimem/relief.png").ReadAsArray()[:3].astype(int)


def differ(a, b):
    """Share of the pixels that differ."""
    return float((abs(a - b).max(axis=0) > 8).mean())


def check_volume(browser, out):
    """The flow as it is drawn holds the volume of the GeoTIFF, but for what is thinner than the first class."""
    drawn = browser.execute_script("return report.relief.relief.volume(report.relief.relief.flows.length - 1)")
    deposit = gdal.Open(f"{out}/maps/deposit_thickness.tif")
    values = deposit.ReadAsArray()
    volume = values[values > 0].sum() * deposit.GetGeoTransform()[1] ** 2
    assert abs(drawn / volume - 1) < 0.02, f"{drawn:.0f} m3 are drawn, the map holds {volume:.0f}"


def check_player(browser):
    last = seen(browser)
    slider = browser.find_element(By.ID, "relief-time")
    browser.execute_script("arguments[0].value = 0; arguments[0].dispatchEvent(new Event('input'));", slider)
    label = browser.find_element(By.ID, "relief-time-label")
    assert label.text.startswith("t = 0.0 of 3.0"), f"the first frame is at {label.text}"
    first = seen(browser)
    assert differ(first, last) > 0.003, "the flow does not move"
    flow = browser.find_element(By.ID, "relief-flow")
    flow.click()
    assert differ(seen(browser), first) > 0.003, "the flow does not go away"
    flow.click()
    browser.find_element(By.ID, "relief-play").click()
    WebDriverWait(browser, 20).until(lambda b: label.text.startswith("t = 3.0"))
    WebDriverWait(browser, 20).until(lambda b: b.execute_script("return !report.relief.timer"))


def check_turning(browser):
    """The page scrolls past the view until it is clicked; then the mouse turns it. Keys turn it at any time."""
    view = browser.find_element(By.ID, "relief")
    before = seen(browser)
    view.send_keys(Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    keys = seen(browser)
    assert differ(keys, before) > 0.02, "the arrow keys do not turn it"
    ActionChains(browser).drag_and_drop_by_offset(view, 120, 30).perform()
    ActionChains(browser).drag_and_drop_by_offset(view, 120, 30).perform()
    assert differ(seen(browser), keys) > 0.02, "the mouse does not turn it"


def check_choices(browser):
    browser.find_element(By.ID, "relief-flow").click()  # it covers most of what it has run over
    before = seen(browser)
    for name, value in [("relief-ground", "peak_speed"), ("relief-times", "2")]:
        browser.execute_script(
            "const s = document.getElementById(arguments[0]); s.value = arguments[1];"
            "s.dispatchEvent(new Event('change'));",
            name,
            value,
        )
        after = seen(browser)
        assert differ(after, before) > 0.01, f"{name} = {value} changes nothing"
        before = after


def check(browser, out):
    """Nothing is drawn before the section is near the screen; then it shows what it should and does as it is told."""
    section = browser.find_element(By.ID, "relief-section")
    browser.execute_script("arguments[0].scrollIntoView()", section)
    WebDriverWait(browser, 30).until(lambda b: b.execute_script("return !!report.relief.scene"))
    picture = seen(browser)
    colours = {tuple(p) for p in picture.reshape(3, -1)[:, ::7].T.tolist()}
    assert len(colours) > 100, f"the view has {len(colours)} colours"
    browser.save_screenshot(f"{out}/relief.png")
    check_volume(browser, out)
    check_player(browser)
    check_turning(browser)
    check_choices(browser)


def check_without(browser):
    """A line says what is missing and what stands for it; no controls are left."""
    assert not browser.find_elements(By.ID, "relief-view"), "controls of a view that is not there"
    note = browser.find_element(By.ID, "relief-note").text
    assert "no WebGL" in note and "map above" in note, f"the note says: {note}"


def check_printed(browser):
    """On paper the flow is seen on its way and at the end, though nobody has scrolled to the view."""
    browser.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    pictures = browser.execute_script(
        "return [...document.querySelectorAll('#relief-plates img')].map((image) => image.src)"
    )
    assert len(pictures) == 2 and pictures[0] != pictures[1], f"{len(pictures)} pictures of the view for paper"
    assert all(picture.startswith("data:image/png") for picture in pictures)
