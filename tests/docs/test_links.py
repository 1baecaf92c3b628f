"""Links, widths and paragraphs of the Markdown pages: test_links.py ROOT

- Every relative link of every *.md names a file that exists, and its anchor a heading there.
- Every path docs/... that a source, script or page names exists.
- In docs/ and README.md a line of prose has at most 100 columns (tables, code and links excepted),
  and a paragraph at most eight lines.
"""
import re
import subprocess
import sys
from pathlib import Path

# Pages that are about to be replaced by docs/theory and docs/evidence.
LEAVING = ["docs/contact.md", "docs/elements.md", "docs/harmonic_balance.md", "docs/rotation.md",
           "docs/scale.md", "docs/time_integration.md"]
# Targets that need not be there yet; once they are, links to them are checked like all others.
COMING = ["docs/theory", "docs/developer", "docs/evidence"]
MOST_COLUMNS, MOST_LINES = 100, 8
NAMED = re.compile(r"\bdocs/[A-Za-z0-9_./-]*[A-Za-z0-9_]\.(?:md|svg|py)\b")
TEXT = {".c", ".h", ".py", ".sh", ".cmake", ".txt", ".yaml", ".geo", ".js", ".md", ""}


def files(root):
    """All files that git knows, or would add."""
    out = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"],
                         capture_output=True, text=True)
    if out.returncode == 0:
        return [root / name for name in out.stdout.splitlines() if (root / name).is_file()]
    return [p for p in root.rglob("*") if p.is_file() and "build" not in p.parts]


def without_code(text):
    """The lines of a page, those of code blocks emptied."""
    lines, code = [], False
    for line in text.splitlines():
        fence = line.lstrip().startswith(("```", "~~~"))
        code ^= fence
        lines.append("" if code or fence else line)
    return lines


def anchors(page):
    """Anchors as GitHub makes them of headings."""
    found, count = set(), {}
    for line in without_code(page.read_text(encoding="utf-8")):
        heading = re.match(r"#+\s+(.*)", line)
        if not heading:
            continue
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.group(1)).lower()
        slug = re.sub(r"[^\w\- ]", "", words).strip().replace(" ", "-")
        n = count.get(slug, 0)
        count[slug] = n + 1
        found.add(slug if n == 0 else f"{slug}-{n}")
    return found


def is_coming(root, path):
    name = path.relative_to(root).as_posix() if path.is_relative_to(root) else ""
    return any((name == c or name.startswith(c + "/")) and not (root / c).exists() for c in COMING)


def check_links(root, page, faults):
    for i, line in enumerate(without_code(page.read_text(encoding="utf-8")), 1):
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = (page.parent / name).resolve() if name else page
            if is_coming(root, path):
                continue
            if not path.exists():
                faults.append(f"{page.relative_to(root)}:{i}: no file {target}")
            elif anchor and path.suffix == ".md" and anchor not in anchors(path):
                faults.append(f"{page.relative_to(root)}:{i}: no heading {target}")


def check_named(root, path, faults):
    if path.suffix not in TEXT or path.name == Path(__file__).name:
        return
    text = path.read_text(encoding="utf-8", errors="replace")
    for match in NAMED.finditer(text):
        before = text[:match.start()]
        if before.endswith("/"):
            continue  # a relative link, checked above, or another folder docs
        target = root / match.group()
        if not target.exists() and not is_coming(root, target):
            line = before.count("\n") + 1
            faults.append(f"{path.relative_to(root)}:{line}: no file {match.group()}")


def check_prose(root, page, faults):
    """A list item, a heading, a table or a blank line ends a paragraph."""
    run = 0
    for i, line in enumerate(without_code(page.read_text(encoding="utf-8")), 1):
        place = f"{page.relative_to(root)}:{i}"
        apart = not line.strip() or line.lstrip().startswith(("|", "#", "!["))
        item = re.match(r"\s*([-*+]|\d+\.)\s", line)
        run = 0 if apart else 1 if item else run + 1
        if run == MOST_LINES + 1:
            faults.append(f"{place}: a paragraph of more than {MOST_LINES} lines")
        wide = len(re.sub(r"\]\([^)]*\)", "]", line)) > MOST_COLUMNS
        if wide and not line.lstrip().startswith("|") and not line.startswith("    "):
            faults.append(f"{place}: {len(line)} columns")


def main():
    root = Path(sys.argv[1]).resolve()
    faults, pages = [], 0
    for path in files(root):
        name = path.relative_to(root).as_posix()
        if name in LEAVING:
            continue
        check_named(root, path, faults)
        if path.suffix == ".md":
            pages += 1
            check_links(root, path, faults)
            if name == "README.md" or name.startswith("docs/"):
                check_prose(root, path, faults)
    print("\n".join(faults))
    print(f"{pages} pages, {len(faults)} faults")
    if pages < 20:
        sys.exit("pages were not found")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
