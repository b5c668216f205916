"""The page as a real browser shows it."""

import json

import pytest


def wait_until(tab, condition):
    """Asked from outside again and again: the page's own policy lets no text be evaluated in it, as
    `wait_for_function` does from its second look on."""
    for _ in range(200):
        if tab.evaluate(condition):
            return
        tab.wait_for_timeout(50)
    pytest.fail(f"never came true: {condition}")


def drawn(tab):
    """Plot -> what it holds that is drawn, and what it should."""
    return tab.evaluate(
        """() => Object.fromEntries(JSON.parse(document.getElementById("plots").textContent).map(
            (plot) => {
              const box = document.getElementById("plot-" + plot.key);
              const there = (s) => (!s.views.length || s.views.includes(plot.views[0])) &&
                s.x.some((x, i) => x !== null && s.y[i] !== null);
              return [plot.key, {
                traces: box.querySelectorAll("svg.main-svg g.trace").length,
                wanted: plot.series.filter(there).length,
              }];
            }))"""
    )


def test_it_opens_without_a_complaint_and_asks_nobody(shown):
    assert shown.complaints == []
    assert shown.requests == [shown.address]


def test_every_plot_is_drawn(shown):
    plots = drawn(shown.tab)
    assert {"at-a-glance", "residual-time", "allan", "estimators-inside"} <= plots.keys()
    for key, count in plots.items():
        assert count["traces"] == count["wanted"] > 0, key


def test_nothing_scrolls_sideways_and_nothing_moves_while_it_is_drawn(shown):
    assert shown.tab.evaluate("document.documentElement.scrollWidth - innerWidth") == 0
    assert shown.tab.evaluate("window.shifted") < 0.01


def test_every_plot_and_button_says_what_it_is(shown):
    plots = json.loads(shown.tab.locator("#plots").text_content())
    pictures = shown.tab.locator("[role=img]")
    assert pictures.count() == len(plots)
    for i in range(pictures.count()):
        assert len(pictures.nth(i).get_attribute("aria-label")) > 40
    named = "b => b.textContent.trim() || b.getAttribute('aria-label')"
    assert shown.tab.evaluate(f"[...document.querySelectorAll('button')].every({named})")
    assert shown.tab.locator("h1").count() == 1


def test_text_stands_out_from_its_ground(shown):
    css = "(name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim()"
    colours = {name: shown.tab.evaluate(css, f"--{name}") for name in TEXTS}
    ground = luminance(shown.tab.evaluate(css, "--ground"))
    for name, colour in colours.items():
        dim, bright = sorted([luminance(colour), ground])
        assert (bright + 0.05) / (dim + 0.05) >= 4.5, name


TEXTS = ("text", "muted", "link", "good", "doubt")


def luminance(colour):
    """Of #rrggbb, as WCAG 2.1 defines relative luminance."""
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


class TestInUse:
    def test_pointing_at_a_curve_tells_its_values(self, tab):
        plot = tab.locator("#plot-residual-time")
        plot.scroll_into_view_if_needed()
        box = plot.bounding_box()
        for share in (0.3, 0.4, 0.5):
            for down in range(30, 130, 8):
                tab.mouse.move(box["x"] + share * box["width"], box["y"] + down)
                if plot.locator(".hoverlayer .hovertext").count():
                    said = plot.locator(".hoverlayer .hovertext").first.text_content()
                    assert "mdps" in said and "minutes since the start of d" in said
                    return
        pytest.fail("nothing is said of any point")

    def test_dragging_zooms_and_a_double_click_shows_all_again(self, tab):
        plot = tab.locator("#plot-residual-time")
        plot.scroll_into_view_if_needed()
        box = plot.bounding_box()
        extent = "document.getElementById('plot-residual-time')._fullLayout.xaxis.range.slice()"
        whole = tab.evaluate(extent)
        tab.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 60)
        tab.mouse.down()
        tab.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 62, steps=6)
        tab.mouse.up()
        zoomed = tab.evaluate(extent)
        assert whole[0] < zoomed[0] < zoomed[1] < whole[1]
        tab.mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 60)
        wait_until(tab, f"Math.abs(({extent})[0] - {whole[0]}) < 1e-6")

    def test_the_theme_is_the_systems_until_it_is_switched(self, tab):
        colours = """() => [getComputedStyle(document.documentElement).backgroundColor,
            document.querySelector("#plot-residual-time .trace path").style.stroke]"""
        light = tab.evaluate(colours)
        tab.locator("#theme").click()
        dark = tab.evaluate(colours)
        assert [a != b for a, b in zip(light, dark)] == [True, True]
        tab.emulate_media(color_scheme="dark")
        assert tab.evaluate(colours) == dark
        tab.locator("#theme").click()
        assert tab.evaluate(colours) == light

    def test_the_error_before_is_shown_when_asked_for(self, tab):
        shown = "document.getElementById('plot-residual-temperature')._fullData.map(t => t.visible)"
        after = tab.evaluate(shown)
        tab.locator("#figure-residual-temperature [data-view=before]").click()
        before = tab.evaluate(shown)
        assert any(after) and [not v for v in after] == before

    def test_a_name_of_the_legend_hides_its_curves(self, tab):
        count = tab.locator("#plot-residual-time g.trace").count()
        tab.locator("#figure-residual-time [data-name=before]").click()
        assert tab.locator("#plot-residual-time g.trace").count() == count - 3

    def test_the_slider_goes_through_the_moments(self, tab):
        figure = tab.locator("#figure-estimators-inside")
        last = figure.locator("output").text_content()
        figure.locator("input").fill("3")
        assert figure.locator("output").text_content() != last
        values = "document.getElementById('plot-estimators-inside').data[0].y"
        frames = json.loads(tab.locator("#plots").text_content())[-1]["frames"]
        assert tab.evaluate(values) == frames[3][1]["0"]["y"]

    def test_a_finger_on_a_plot_scrolls_the_page(self, outcome, show):
        tab = show(outcome("an effect"), phone=True).tab
        curves = tab.locator("#plot-residual-time .nsewdrag").nth(2)
        curves.scroll_into_view_if_needed()
        box, before = curves.bounding_box(), tab.evaluate("scrollY")
        finger = tab.context.new_cdp_session(tab)
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        for i in range(10):
            kind = "touchMove" if i else "touchStart"
            points = [{"x": x, "y": y - 20 * i}]
            finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        finger.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        wait_until(tab, f"scrollY > {before} + 100")
        tab.context.close()


class TestHostileNames:
    def test_they_are_shown_letter_by_letter_and_make_no_element(self, outcome, show):
        closed = outcome("hostile names")
        tab = show(closed).tab
        name = closed.analysis.holdout[0].name
        assert tab.locator("#good bdi.name").first.text_content() == name
        axis = tab.locator("#plot-residual-time .xtitle, #plot-residual-time .x4title")
        assert name in axis.last.text_content()
        assert tab.locator("#found .effect h3 bdi").first.text_content().startswith("<script>, ")
        assert tab.locator("#plot-effect-1 .xtitle").text_content().startswith("\u2068delayed <scr")
        assert tab.locator("img").count() == 0
        assert tab.locator("script").count() == 3
