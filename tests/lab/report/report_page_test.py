# SPDX-License-Identifier: Apache-2.0
"""What a browser shows of a report: lab/report/page/ with data of every kind, and hostile data. Skipped without chromium,
which `./dev setup --browser` installs. With PELAGE_SCREENSHOTS=DIR, keeps a picture of the page."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

PAGE = pathlib.Path(__file__).resolve().parents[3] / "lab/report/page"
CHROMIUM = shutil.which("chromium")
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync"]
HOSTILE = "</script><img src=x onerror=\"document.title='owned'\"> & <b> \u0001"
AXIS = {"label": "x", "quantity": "ratio", "log": False, "end": 0}


def page_of(*blocks, **members):
    """As report_page.cpp makes it."""
    data = {"title": "title", "abstract": "", "facts": [], "sections": [{"heading": "h", "blocks": blocks}], **members}
    page = (PAGE / "report.html").read_text()
    for name in "report.css", "report.js":
        page = page.replace("{{" + name + "}}", (PAGE / name).read_text())
    return page.replace("{{report.json}}", json.dumps(data).replace("<", "\\u003c"))


def line_plot(*lines, areas=(), **members):
    return {"kind": "lines", "caption": "", "half": False, "x": AXIS, "y": AXIS, "markers": False,
            "areas": [{"name": f"area {i}", "points": p} for i, p in enumerate(areas)],
            "lines": [{"name": f"line {i}", "points": p} for i, p in enumerate(lines)], **members}


def bar_plot(groups, series, **members):
    return {"kind": "bars", "caption": "", "half": False, "value": AXIS, "groups": groups, "stacked": False, "spread": [],
            "notes": [], "series": [{"name": f"s{i}", "values": values} for i, values in enumerate(series)], **members}


def table(columns, *rows):
    return {"kind": "table", "caption": "c", "rows": rows,
            "columns": [{"title": title, "quantity": quantity} for title, quantity in columns]}


class Page(unittest.TestCase):
    def show(self, page, *flags):
        # Processes of the browser may still write when it has ended.
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            file = pathlib.Path(folder) / "report.html"
            file.write_text(page)
            run = subprocess.run([CHROMIUM, *FLAGS, f"--user-data-dir={folder}/profile", *flags, f"file://{file}"],
                                 capture_output=True, text=True, timeout=120)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def dom(self, page):
        dom = self.show(page, "--dump-dom")
        self.assertNotIn("NaN", re.sub(r"(?s)<script.*?</script>", "", dom))
        return dom

    def elements(self, dom, pattern):
        return re.findall(pattern, re.sub(r"(?s)<script.*?</script>", "", dom))

    def texts(self, dom, name="text"):
        return self.elements(dom, rf"<{name}\b[^>]*>([^<]*)</{name}>")

    def test_texts_of_the_report_are_no_markup(self):
        dom = self.dom(page_of({"kind": "paragraph", "text": HOSTILE}, table([(HOSTILE, "ratio")], [HOSTILE]),
                               line_plot([[0, 1], [1, 2]], caption=HOSTILE), bar_plot([HOSTILE], [[1]], notes=[HOSTILE]),
                               title=HOSTILE, abstract=HOSTILE, facts=[[HOSTILE, HOSTILE]]))
        self.assertEqual(self.elements(dom, "<img|<b>(?!Table|Figure)"), [])
        shown = HOSTILE.replace("\u0001", "\ufffd").replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
        self.assertEqual(self.texts(dom, "title")[0], shown)
        for name in "h1", "dt", "dd", "p", "td":
            self.assertIn(shown, self.texts(dom, name), name)

    def test_numbers_read_well(self):
        dom = self.dom(page_of(table([("n", "count"), ("b", "bytes"), ("s", "seconds"), ("p", "percent"), ("e", "error"), ("r", "ratio")],
                                     [12345678, 3 << 20, 0.05, 0.25, 0.0022, -1234], [9999, None, 0.0125, 1, 0.64, {"infinite": -1}],
                                     ["text", 9 << 20, None, -0.0001, 0, {"infinite": 1}])))
        self.assertEqual(self.texts(dom, "th"), ["n", "b (MiB)", "s (ms)", "p (%)", "e (%)", "r"])
        self.assertEqual(self.texts(dom, "td"), ["12\u202f345\u202f678", "3.000", "50.00", "25.0", "0.220", "−1234",
                                                 "9999", "–", "12.50", "100.0", "64.000", "−∞",
                                                 "text", "9.000", "–", "0.0", "0.000", "∞"])
        self.assertEqual(self.elements(dom, r'<td class="(\w+)"'), ["text"] * 3)

    def test_ticks_are_round(self):
        log = {"label": "y", "quantity": "ratio", "log": True, "end": 0}
        labels = self.texts(self.dom(page_of(line_plot([[0, 3], [10, 100]], y=log))))
        self.assertEqual(labels[:4], ["0.0", "0.5", "1.0", "1.5"])  # across
        self.assertEqual(labels[-7:-2], ["5", "10", "20", "50", "100"])  # up; then the title and the legend
        wide = self.texts(self.dom(page_of(line_plot([[0, 1], [1, 1e6]], y=log))))
        self.assertEqual(wide[-9:-2], ["1", "10", "100", "1000", "10\u202f000", "100\u202f000", "1\u202f000\u202f000"])

    def test_lines_are_interrupted_where_numbers_are_missing(self):
        gaps = line_plot([[0, 1], [1, 2], [2, None], [3, 4], [4, 5], [5, {"infinite": 1}], [None, 3], [7, 1]], markers=True)
        dom = self.dom(page_of(gaps))
        self.assertEqual(len(self.elements(dom, "<polyline")), 3)  # two pieces, and the legend's
        self.assertEqual(len(self.elements(dom, "<circle")), 5)

    def test_plots_without_data_are_plots(self):
        log = dict(AXIS, log=True)
        missing = [[None], [{"infinite": 1}, -3]]
        dom = self.dom(page_of(line_plot(x=log, y=log), line_plot([[1, -1]], y=log), bar_plot(["a", "b"], missing),
                               bar_plot(["a", "b"], missing, stacked=True), bar_plot([], []), bar_plot(["a"], [[-2]], value=log),
                               line_plot(areas=[[], [[0, 1]]])))
        self.assertEqual(len(self.elements(dom, "<svg")), 7)
        self.assertNotIn("Infinity", dom.split("</script>")[-1])

    def test_areas_are_stacked(self):
        dom = self.dom(page_of(line_plot([[0, 3], [1, 3]], areas=[[[0, 1], [1, 1]], [[0, 2], [1, None]]])))
        first, second = (dict(p.split(",") for p in points.split()) for points in self.elements(dom, r'<polygon[^>]*points="([^"]*)"'))
        self.assertEqual(len(first), 2)
        self.assertEqual(first.keys(), second.keys())
        self.assertEqual(self.elements(dom, r'<polyline class="line (\w+)"'), ["ink", "ink"])

    def test_bars_show_spread_and_notes(self):
        marks = lambda dom: len(self.elements(dom, 'class="axis"'))
        plain = self.dom(page_of(bar_plot(["a", "b"], [[2, None]])))
        noted = self.dom(page_of(bar_plot(["a", "b"], [[2, None]], spread=[[1, 3], [None, None]], notes=["", "refused"])))
        self.assertEqual(marks(noted), marks(plain) + 3)
        self.assertIn("refused", self.texts(noted))
        self.assertIn("–", self.texts(plain))

    def test_pictures_have_labels(self):
        pixel = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FQAAAABJRU5ErkJggg=="
        picture = {"kind": "picture", "caption": "c", "half": True, "width": 20, "height": 10, "source": pixel, "labels": []}
        label = {"x": 5, "y": 8, "text": "R & TT", "anchor": "middle", "color": [255, 0, 16], "size": 12}
        dom = self.dom(page_of(picture, dict(picture, labels=[label])))
        self.assertEqual(len(self.elements(dom, "<img")), 1)
        self.assertIn("R &amp; TT", self.texts(dom))
        self.assertEqual(self.elements(dom, r'style="font-size:12px;fill:rgb\(([^)]*)'), ["255,0,16"])

    def test_figures_are_saved_as_files(self):
        """The file is well-formed XML, with its own colours."""
        page = page_of(bar_plot([HOSTILE], [[1]]), line_plot([[0, 1], [1, 2]]))
        page = page.replace("</body>", """<script>
          window.Blob = class { constructor(parts) { document.title = parts.join(''); } };
          URL.createObjectURL = () => 'about:blank';
          HTMLAnchorElement.prototype.click = function() { document.body.dataset.name = this.download; };
          document.querySelectorAll('button')[1].click();
        </script></body>""")
        dom = self.dom(page)
        self.assertEqual(self.elements(dom, r'data-name="([^"]*)'), ["figure-02.svg"])
        file = self.texts(dom, "title")[0].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
        root = xml.fromstring(file)
        self.assertTrue(root.tag.endswith("}svg"))
        self.assertIn("svg .line.s0 { stroke: #0072b2; }", root[0].text)

    def test_looks(self):
        folder = os.environ.get("PELAGE_SCREENSHOTS")
        if folder:
            self.show(page_of(line_plot([[0, 1], [1, 2]], markers=True), bar_plot(["a", "b"], [[1, 2], [2, None]])),
                      f"--screenshot={folder}/report.png", "--window-size=1000,1000")


if __name__ == "__main__":
    if not CHROMIUM:
        print("skipped: needs chromium")
        sys.exit(77)
    unittest.main()
