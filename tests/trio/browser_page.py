#!/usr/bin/env python3
"""The page of a map in a headless browser: browser_page.py URL [PICTURE]. Exit code 1 and a reason when something is wrong.

It looks at the map, clicks on a segment, asks for its neighbours, searches, and counts colours of the picture on the canvas."""

import sys

from browser import Browser

# Colours on the canvas that are not the background, each counted once for 32 x 32 x 32 of all.
COLOURS = """(() => {
  const canvas = document.getElementById('map');
  const gl = canvas.getContext('webgl2');
  const pixels = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const seen = new Set();
  let drawn = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i] === 24 && pixels[i + 1] === 28 && pixels[i + 2] === 34) continue;
    ++drawn;
    seen.add((pixels[i] >> 3) << 10 | (pixels[i + 1] >> 3) << 5 | pixels[i + 2] >> 3);
  }
  return {share: drawn / (canvas.width * canvas.height), colours: seen.size};
})()"""

# A place of the canvas with a segment, and that segment.
FIND = """(() => {
  const canvas = document.getElementById('map');
  const {page} = kintsugi;
  for (let ring = 0; ring < 12; ++ring) {
    for (let k = 0; k < 24; ++k) {
      const x = canvas.clientWidth * (0.5 + 0.035 * ring * Math.cos(k));
      const y = canvas.clientHeight * (0.5 + 0.035 * ring * Math.sin(k));
      const id = page.pick(x, y);
      if (id !== 0 && document.elementFromPoint(x, y) === canvas) return {x, y, id};
    }
  }
  return null;
})()"""

# Two known objects in the middle of the map, and one in another part of it: their names on the page, in the list.
OBJECTS = """(() => {
  const {page} = kintsugi;
  const [min, max] = page.tiles.box();
  const t = min.map((low, i) => (low + max[i]) / 2 + page.tiles.origin[i]);
  const at = {q: [0, 0, 0, 1], box_min_O: [-0.2, -0.2, -0.2], box_max_O: [0.2, 0.2, 0.2]};
  page.objects.set([{...at, t, name: 'mug', confirmed: true}, {...at, t, name: '<i>cup</i>', confirmed: false},
    {...at, t: t.map((x) => x + 1000), name: 'elsewhere', confirmed: true}], page.tiles.box(), page.tiles.origin);
  page.overview();
  page.frame(0);
  const names = [...document.querySelectorAll('#names span')];
  const {bottom, top} = names[0].getBoundingClientRect();
  const other = names[1].getBoundingClientRect();
  const canvas = document.getElementById('map');
  return {names: names.map((e) => e.textContent), list: document.getElementById('object_list').textContent,
    overlap: top < other.bottom && other.top < bottom,
    shown: names.every((e) => !e.hidden && e.getBoundingClientRect().right <= canvas.clientWidth),
    lines: page.objects.lines.positions.length};
})()"""


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def main():
    url = sys.argv[1]
    with Browser() as browser:
        browser.go(url)
        browser.until("window.kintsugi && kintsugi.stats().points_held > 1000 && kintsugi.stats().segments > 5"
                      " && kintsugi.stats().is_waiting && kintsugi.page.batches")
        browser.wait_for("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        in_segments = browser.run(f"kintsugi.page.frame(0); return {COLOURS}")
        check(in_segments["share"] > 0.05 and in_segments["colours"] > 30, f"the map is not there: {in_segments}")
        browser.run("document.querySelector('input[value=true]').click()")
        in_colour = browser.run(f"kintsugi.page.frame(0); return {COLOURS}")
        check(in_colour["colours"] > 30 and in_colour != in_segments, f"true colour is no other picture: {in_colour}")
        browser.run("document.querySelector('input[value=segments]').click()")

        place = browser.run(f"return {FIND}")
        check(place, "there is no segment to click on")
        browser.click(place["x"], place["y"])
        browser.until(f"kintsugi.stats().selected === {place['id']}", 10)
        browser.until("document.getElementById('neighbours').textContent !== ''", 20)
        name = browser.run("return document.getElementById('selected_name').textContent")
        facts = browser.run("return document.getElementById('facts').textContent")
        check(name == f"Segment {place['id']}", f"the panel has {name!r}")
        check("points" in facts and "plane" in facts and "box" in facts, f"facts: {facts!r}")
        if len(sys.argv) > 2:
            browser.picture(sys.argv[2])

        listed = "document.querySelectorAll('#list .item').length"
        before = browser.run(f"return {listed}")
        browser.run("const c = document.getElementById('planar_only'); c.click()")
        planar = browser.run(f"return {listed}")
        check(0 < planar < before or before == 200, f"{planar} of {before} listed segments are planar")
        browser.run("const i = document.getElementById('min_points'); i.value = '1000000000';"
                    " i.dispatchEvent(new Event('input'))")
        check(browser.run(f"return {listed}") == 0, "a segment has a thousand million points")

        objects = browser.run(f"return {OBJECTS}")
        check(objects["names"] == ["mug", "<i>cup</i>"] and objects["shown"], f"names of objects: {objects}")
        check(objects["list"] == "mugconfirmed<i>cup</i>found", f"list of objects: {objects['list']!r}")
        check(not objects["overlap"], "the names of two objects cover each other")
        check(objects["lines"] == 12 * 6 * (1 + 7), f"{objects['lines']} coordinates of lines of a box and a dashed box")
        if len(sys.argv) > 2:
            browser.picture(sys.argv[2].replace(".png", "_objects.png"))

        check(not browser.messages(), f"errors in the browser: {browser.messages()}")
        outside = browser.run("return performance.getEntriesByType('resource').map((e) => e.name)"
                              ".filter((name) => !name.startsWith(location.origin) && !name.startsWith('data:'))")
        check(url.startswith("file:") and not outside or not outside, f"loaded from elsewhere: {outside}")
        print(f"{url}: {browser.run('return kintsugi.stats()')}")
        print(f"turning: {browser.wait_for('kintsugi.spin(10)')}")


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(f"browser_page: {error}")
