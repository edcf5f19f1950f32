#!/usr/bin/env python3
"""Opens the report.html of impinge diff in headless Chromium and uses it, as report_in_browser.py does with a sweep's.

usage: diff_in_browser.py REPORT [--pictures FOLDER]
"""
import sys

import report_in_browser as browser


def use(page, report, check):
    page.open(report.as_uri())
    rows = page.ask("rows.length")
    check(rows > 1 and rows == page.ask("data.length"), f"the list has a row for each of {rows} pictures")
    pixels = page.ask("rows.map(r => r.cells[2].textContent).filter(t => t !== '').map(Number)")
    check(pixels == sorted(pixels, reverse=True), "the most different first")
    decoded = "Promise.all(['a', 'b', 'd'].map(i => document.getElementById(i)).filter(i => i.getAttribute('src')).map(i => i.decode().then(() => i.naturalWidth > 0)))"
    check(page.ask(decoded) == [True, True, True], "the first row's pictures are there")

    name = page.ask("document.getElementById('name').textContent")
    source = page.ask("document.getElementById('a').src.length")
    page.click("#frames tbody tr", rows - 1)
    check(page.ask("document.getElementById('name').textContent") == page.ask(f"data[{rows - 1}].name") != name, "a click on a row shows it")
    check(page.ask("document.getElementById('say').children.length") == page.ask(f"data[{rows - 1}].say.length") > 0, "with what was found")
    page.click("#frames tbody tr", 0)
    page.key("ArrowDown", 40)
    check(page.ask("now") == 1 and page.ask("document.querySelectorAll('#frames tr.on').length") == 1, "an arrow key goes on by one row")
    page.key("ArrowUp", 38)
    check(page.ask("document.getElementById('a').src.length") == source, "and back")

    cut = "Number(getComputedStyle(document.getElementById('a')).clipPath.match(/inset\\(0(?:px)? ([0-9.]+)%/)[1])"
    page.click("#wipe", across=0.25)
    left = page.ask(cut)
    page.click("#wipe", across=0.75)
    right = page.ask(cut)
    check(60 < left < 90 and 10 < right < 40, f"the slider wipes: {left:.0f} % of A cut away, then {right:.0f} %")
    stage = page.ask("(() => { const e = document.getElementById('stage'); e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()")
    page.call("Input.dispatchMouseEvent", type="mousePressed", x=stage[0] + 0.4 * stage[2], y=stage[1] + 0.5 * stage[3], button="left", buttons=1, clickCount=1)
    page.call("Input.dispatchMouseEvent", type="mouseMoved", x=stage[0] + 0.5 * stage[2], y=stage[1] + 0.5 * stage[3], button="left", buttons=1)
    page.call("Input.dispatchMouseEvent", type="mouseReleased", x=stage[0] + 0.5 * stage[2], y=stage[1] + 0.5 * stage[3], button="left", clickCount=1)
    page.settle()
    check(abs(page.ask(cut) - 50) < 2, "so does the pointer over the picture")
    for value, seen in (("a", 0), ("b", 100)):
        page.click(f"[name=mode][value={value}]")
        check(abs(page.ask(cut) - seen) < 1, f"the choice {value.upper()} shows {value.upper()} alone")
    page.click("[name=mode][value=diff]")
    check(page.ask("!document.getElementById('d').hidden"), "the choice of the difference shows it")
    page.click("[name=mode][value=wipe]")
    check(page.ask("document.getElementById('d').hidden"), "and wiping hides it")

    box = page.ask("(() => { const b = document.getElementById('box').getBoundingClientRect(), s = document.getElementById('stage').getBoundingClientRect(), d = data[now], z = Number(document.getElementById('zoom').value);"
                   " return [b.left + 2 - s.left - d.box[0] * z, b.top + 2 - s.top - d.box[1] * z, b.width - 4 - d.box[2] * z]; })()")
    check(all(abs(v) < 1 for v in box), f"the worst window is framed where it is {box}")
    page.click("#frame")
    check(page.ask("document.getElementById('box').hidden"), "its frame can be taken away")
    page.click("#frame")
    for width in (1280, 1920):
        page.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        page.settle()
        check(page.ask("document.documentElement.scrollWidth") <= width, f"nothing is cut off at {width} pixels")

    outside = [u for u in page.requests if not u.startswith("data:") and u != report.as_uri()]
    check(not outside, f"nothing but the page itself is asked for {outside[:3]}")
    check(not page.complaints, f"the console is silent {page.complaints[:3]}")


browser.use = use
if __name__ == "__main__":
    sys.exit(browser.main())
