"""The site in Chromium: every page on a phone and on a desk, its pictures, its search; nothing is asked of any other host.

usage: test.py FOLDER [PICTURES]     PICTURES: a folder for a picture of each page's beginning
"""
import functools
import http.server
import pathlib
import sys
import threading

from playwright.sync_api import sync_playwright

SIZES = {"phone": (390, 844), "desk": (1280, 900)}


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def serve(folder):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}/"


def check_page(page, address, size, faults):
    page.set_viewport_size({"width": SIZES[size][0], "height": SIZES[size][1]})
    page.goto(address)
    wide = page.evaluate("document.scrollingElement.scrollWidth - innerWidth")
    if wide > 1:
        faults.append(f"{address} at {size}: {wide} pixels too wide")
    page.evaluate("document.querySelectorAll('img').forEach(image => image.loading = 'eager')")
    page.wait_for_load_state("networkidle")
    for source in page.evaluate("[...document.images].filter(i => i.complete && i.naturalWidth === 0).map(i => i.src)"):
        faults.append(f"{address}: the picture {source} does not load")


def check_search(page, address, faults):
    page.goto(address)
    page.locator("input.md-search__input").first.fill("penumbra")
    page.wait_for_selector("a.md-search-result__link", timeout=60000)
    if page.locator("a.md-search-result__link").count() < 3:
        faults.append("the search for 'penumbra' finds fewer than 3 pages")


def main():
    folder = pathlib.Path(sys.argv[1])
    pictures = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    pages = sorted(str(page.relative_to(folder)) for page in folder.rglob("*.html") if "tab" not in page.parts)
    address, faults = serve(folder), []
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        page = browser.new_page()
        page.on("request", lambda asked: asked.url.startswith((address, "data:", "blob:")) or faults.append(f"{asked.url} is asked for"))
        page.on("pageerror", lambda error: faults.append(f"{page.url}: {error}"))
        for name in pages:
            for size in SIZES:
                check_page(page, address + name, size, faults)
                if pictures:
                    pictures.mkdir(exist_ok=True)
                    page.screenshot(path=pictures / f"{name.replace('/', '-')}-{size}.png")
        check_search(page, address + "index.html", faults)
        browser.close()
    print(f"{len(pages)} pages at {len(SIZES)} sizes, {len(faults)} faults", *faults, sep="\n")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
