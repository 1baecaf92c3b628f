"""Pages in a browser: chromium's headless shell where it is installed, which starts three times
as fast, or chromium itself."""
import json
import re
import subprocess
from html import unescape

# Without these a browser waits for a network, which a test does not need.
OFFLINE = ('--no-first-run', '--disable-background-networking', '--disable-component-update',
           '--disable-sync', '--disable-quic')
# WebGL on a machine without a graphics card
WEBGL = ('--use-angle=swiftshader', '--enable-unsafe-swiftshader')


def visit(chromium, folder, page, script):
    """The console's lines, and what the script left in the title as "seen JSON"; None without.

    page is HTML; script, HTML too, acts on it after all else.
    """
    acted = folder / 'acted.html'
    acted.write_text(page.replace('</body>', script + '</body>'))
    run = subprocess.run(
        [chromium, '--headless', '--no-sandbox', '--disable-gpu', *OFFLINE, *WEBGL,
         f'--user-data-dir={folder}/user', '--enable-logging=stderr', '--window-size=1200,900',
         '--virtual-time-budget=6000', '--dump-dom', acted.as_uri()],
        capture_output=True, text=True, timeout=120, check=False)
    console = [line for line in run.stderr.splitlines()  # a test itself reads pixels
               if 'CONSOLE' in line and 'due to ReadPixels' not in line]
    found = re.search(r'<title>seen (.*?)</title>', run.stdout, re.S)
    return console, json.loads(unescape(found.group(1))) if found else None
