#!/usr/bin/env python3
"""The script of the report page in a browser: every control, no error.

    test_page_script.py MAKER CHROMIUM [all]

Without `all` the first pages of the list: what modules do is tested under node.
MAKER NOUN keep writes page_KIND.html into the folder (test_contact_points.c,
test_blade_view.c).
"""
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'support'))
from browser import visit

# Acts on a page as a reader does, then leaves what it saw in the document.
ACTIONS = (Path(__file__).parent / 'page_actions.js').read_text()

DAILY = ('contacts', 'free', 'disc')
KINDS = (*DAILY, 'usual', 'friction', 'many', 'blade', 'large')
BLADES = ('blade', 'large', 'disc')
LOOPS = {'loop-u', 'loop-w', 'path', 'period'}


# The motion of sectors on the page against that of `shroudhb field --ring`.
MOTION = """
<script>
queueMicrotask(() => {
  const Blade = module_report_page.blade;
  Blade.choose(wanted.b, wanted.x, 0, () => "first");
  const select = document.getElementById("blade-shown");
  select.value = "point";
  select.dispatchEvent(new Event("change"));
  let off = 0, size = 0, at = 0;
  for (const s of wanted.sectors)
    for (const x of Blade.motionOf(s, wanted.instant)) {
      off = Math.max(off, Math.abs(x - wanted.u[at]));
      size = Math.max(size, Math.abs(wanted.u[at++]));
    }
  document.title = "seen " + JSON.stringify({off: off / size, left: wanted.u.length - at});
});
</script>"""


def motion_faults(chromium, folder):
    """Sectors of a disc in motion: forward and backward waves."""
    wanted = (folder / 'motion.json').read_text()
    page = (folder / 'page_disc.html').read_text()
    console, seen = visit(chromium, folder, page,
                          f'<script>const wanted = {wanted};</script>' + MOTION)
    if not seen:
        return console + ['the motion did not end']
    print(f'  motion of three sectors: off by {seen["off"]:.1e} of the largest')
    if seen['left']:
        console.append(f'{seen["left"]} numbers are left')
    return console + ([] if seen['off'] < 0.01 else [f'off by {seen["off"]:.2g}'])


def faults(kind, chromium, folder):
    """What is wrong with the page of a kind."""
    page = (folder / f'page_{kind}.html').read_text()
    found, seen = visit(chromium, folder, page, f'<script>{ACTIONS}</script>')
    if not seen:
        return found + ['the actions did not end']
    found += seen['faults']
    if (kind in BLADES) != ('pictures' in seen):
        found.append('no blade' if kind in BLADES else 'a blade')
    if (kind == 'free') != seen['speeds']:  # it runs up
        found.append('axis of speeds')
    if LOOPS <= set(seen['charts']) == (kind in ('free', *BLADES)):
        found.append(f'charts {seen["charts"]}')
    return found


def main():
    maker, chromium, *rest = sys.argv[1:]
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for noun in ('contact_points', 'blade_view'):
            subprocess.run([Path(maker).resolve(), noun, 'keep'], cwd=folder, check=True)
        wrong = motion_faults(chromium, folder)
        print(f'motion: {"; ".join(wrong) or "good"}')
        for kind in KINDS if rest else DAILY:
            found = faults(kind, chromium, folder)
            print(f'{kind}: {"; ".join(found) or "good"}')
            bad += bool(found)
    return 1 if bad or wrong else 0


if __name__ == '__main__':
    sys.exit(main())
