"""Builds the documentation as a site (scripts/docs) and opens every page in headless Chromium, as a file and without network.
   site_test.py SOURCE WORK
No page may have a script that fails, ask for what is not there or for the network, or be wider than the screen, at 1280 and at 400
px. The menu's button opens the menu, the search finds, the colours follow the reader's. Exit code 77: there is no mkdocs here."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

source, work = (pathlib.Path(word).absolute() for word in sys.argv[1:3])
wrong = []


class Chromium:
    """One page of a headless Chromium, driven by its DevTools protocol over two pipes."""

    def __init__(self, program, profile):
        to_browser, self.commands = os.pipe()
        self.answers, from_browser = os.pipe()

        def join_pipes():  # the browser reads from 3 and writes to 4
            high = [os.dup2(end, 100 + i) for i, end in enumerate((to_browser, from_browser))]
            for i, end in enumerate(high):
                os.dup2(end, 3 + i)

        flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-dev-shm-usage", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update", "--disable-sync"]
        self.process = subprocess.Popen([program, *flags, f"--user-data-dir={profile}", "--remote-debugging-pipe", "about:blank"],
                                        close_fds=False, preexec_fn=join_pipes, stderr=subprocess.DEVNULL, env={**os.environ, "HOME": profile})
        os.close(to_browser)
        os.close(from_browser)
        self.rest, self.sent, self.session, self.faults = b"", 0, None, []
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def call(self, method, until=None, **parameters):
        """The result of a command. until: an event to wait for, too."""
        self.sent += 1
        message = {"id": self.sent, "method": method, "params": parameters} | ({"sessionId": self.session} if self.session else {})
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        result = None
        while result is None or until:
            while b"\0" not in self.rest:
                block = os.read(self.answers, 1 << 20)
                if not block:
                    sys.exit("Chromium ended")
                self.rest += block
            text, self.rest = self.rest.split(b"\0", 1)
            said = json.loads(text)
            if said.get("id") == self.sent:
                if "error" in said:
                    sys.exit(f"{method}: {said['error']['message']}")
                result = said["result"]
            elif "method" in said:
                self.note(said["method"], said["params"])
                if said["method"] == until:
                    until = None
        return result

    def note(self, event, what):
        if event == "Runtime.exceptionThrown":
            details = what["exceptionDetails"]
            self.faults.append(details.get("exception", {}).get("description", details["text"]))
        elif event == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
            self.faults.append(" ".join(str(one.get("value", one.get("description"))) for one in what["args"]))
        elif event == "Log.entryAdded" and what["entry"]["level"] == "error":
            self.faults.append(f"{what['entry']['text']} {what['entry'].get('url', '')}")
        elif event == "Network.requestWillBeSent" and not what["request"]["url"].startswith(("file:", "data:", "blob:")):
            self.faults.append("asks for " + what["request"]["url"])

    def look(self, width, scheme="light"):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=width < 500)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def open(self, page):
        """Opens a page and returns what went wrong in it."""
        self.faults = []
        self.call("Page.navigate", until="Page.loadEventFired", url=page)
        return self.faults

    def value(self, expression):
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def click(self, selector, until=None):
        box = self.value(f"""(one => {{ one?.scrollIntoView({{block: 'nearest'}}); const b = one?.getBoundingClientRect();
            return b && [b.x + b.width / 2, b.y + b.height / 2]; }})(document.querySelector({json.dumps(selector)}))""")
        if not box:
            sys.exit("\n".join([*wrong, f"{self.value('location.href')} has no {selector}"]))
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=box[0], y=box[1], button="left", clickCount=1)
        self.call("Input.dispatchMouseEvent", until=until, type="mouseReleased", x=box[0], y=box[1], button="left", clickCount=1)

    def close(self):
        self.process.kill()
        self.process.wait()


def check(right, said):
    if not right:
        wrong.append(said)


def check_in(browser):
    # The adapters' own pages are files of theirs, and need what shoot.mjs gives them.
    pages = sorted(page.relative_to(work).as_posix() for page in work.rglob("*.html") if page.name != "page.html")
    for width in (1280, 400):
        browser.look(width)
        for page in pages:
            for fault in browser.open(f"file://{work}/{page}"):
                check(False, f"{page} at {width} px: {fault}")
            needed = browser.value("document.scrollingElement.scrollWidth")
            check(needed <= width, f"{page} at {width} px is {needed} px wide")

    # The menu on a phone: closed, open after a click on its button, and it leads to the page that is clicked in it.
    shown = "(b => b.width > 0 && b.left >= 0 && b.right <= innerWidth)(document.querySelector('#menu').getBoundingClientRect())"
    for page in ("index.html", "docs/how-to/install.html", "search.html"):
        browser.open(f"file://{work}/{page}")
        check(not browser.value(shown), f"{page}: the menu of a phone is open before a click")
        browser.click("header button")
        check(browser.value(shown), f"{page}: the menu's button opens nothing")
    browser.click("#menu a[href$='ladder.html']", until="Page.loadEventFired")
    check(browser.value("location.pathname").endswith("/ladder.html"), "a click in the menu leads to " + browser.value("location.href"))
    browser.look(1280)
    check(browser.value(shown), "a wide page does not show the menu")

    # Light and dark: paper and ink differ by the contrast that WCAG 2 asks for (4.5, its level AA).
    luminance = """(colour => { const part = c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
        const [r, g, b] = colour.match(/\\d+/g).map(Number); return 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b); })"""
    for scheme in ("light", "dark"):
        browser.look(1280, scheme)
        browser.open(f"file://{work}/index.html")
        paper, ink, link = (browser.value(f"{luminance}(getComputedStyle(document.querySelector('{of}')).{what})")
                            for of, what in (("body", "backgroundColor"), ("main p", "color"), ("main p a", "color")))
        check((paper > 0.5) == (scheme == "light"), f"the paper of the {scheme} page has a luminance of {paper}")
        for name, colour in (("text", ink), ("links", link)):
            contrast = (max(paper, colour) + 0.05) / (min(paper, colour) + 0.05)
            check(contrast >= 4.5, f"the {name} of the {scheme} page have a contrast of {contrast:.2f}")

    # The search, as a reader uses it: from another page, and while typing.
    browser.open(f"file://{work}/docs/explanation/ladder.html")
    browser.value("document.querySelector('#query').value = 'placement'")
    browser.call("Runtime.evaluate", until="Page.loadEventFired", expression="document.querySelector('header form').requestSubmit()")
    found = browser.value("document.querySelectorAll('#found article').length")
    check(found >= 3, f"the search for 'placement' finds {found} sections")
    browser.value("document.querySelector('#query').value = 'polygon off'; document.querySelector('#query').dispatchEvent(new Event('input'))")
    check("polygon" in browser.value("document.querySelector('#found').textContent").lower(), "typing searches nothing")
    links = browser.value("[...document.querySelectorAll('#found a')].map(a => decodeURI(a.href.split('#')[0]))")
    for link in links:
        check(pathlib.Path(link.removeprefix("file://")).is_file(), f"the search leads to {link}")
    check(not browser.faults, f"the search: {browser.faults}")

    # A title is read as a fact, so a claim's says that it is one.
    titles = browser.value("search_index.docs.filter(d => d.location.includes('tutorial-claims.html#')).map(d => d.title)")
    claims = (source / "docs/explanation/tutorial-claims.md").read_text(encoding="utf-8").count("](#")
    check(claims > 0 and sum(title.startswith("Claim: ") for title in titles) == claims,
          f"the table has {claims} claims, and these titles stand in the search: {titles}")


def main():
    if not shutil.which("mkdocs"):
        print("SKIPPED: mkdocs is not installed (scripts/docs installs it)")
        sys.exit(77)
    shutil.rmtree(work, ignore_errors=True)
    subprocess.run([source / "scripts/docs", work], env={**os.environ, "NOONMARK_SETUP": "skip"}, check=True)
    pages = [page for page in (work / "docs").rglob("*.html") if not page.name.startswith("live-cube-room")]
    check(len(pages) == len(list((source / "docs").rglob("*.md"))), f"the site has {len(pages)} pages of docs/")
    if (work / "live-cube-room.html").is_file():  # the program is there
        for page, row in (("settings", "scene.theta_deg"), ("metrics", "map_seen"), ("frame", "camera.fov_y_deg"), ("frame", "samples")):
            check(f"<code>{row}</code></th>" in (work / f"docs/reference/{page}.html").read_text(encoding="utf-8"), f"{page}.html has no row {row}")
    for picture in (source / "docs").rglob("*.png"):
        check((work / picture.relative_to(source)).is_file(), f"the site lacks {picture}")
    program = next(filter(None, map(shutil.which, (os.environ.get("CHROMIUM", "chromium"), "chromium-browser", "google-chrome"))), None)
    if program:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
            browser = Chromium(program, profile)
            try:
                check_in(browser)
            finally:
                browser.close()
    else:
        print("not opened: there is no Chromium")
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(pages)} pages" + (", each opened at 1280 and at 400 px" if program else ""))


if __name__ == "__main__":
    main()
