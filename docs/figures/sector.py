#!/usr/bin/env python3
"""Draw docs/user/sector.svg: the axes of a sector, the shroud angles, the signs and the wave.

Needs the standard library only. Run it in any folder; it writes beside the user pages.
"""
from math import cos, radians, sin
from pathlib import Path

WIDTH, HEIGHT = 800, 860
BLADE, NEIGHBOUR, EDGE = "#c9d6e8", "#ece7da", "#5b6570"
INK, V, U, W, WAVE = "#1f2933", "#c02020", "#1560bd", "#15803d", "#8a4b00"
parts = []


def text(x, y, words, size=14, colour=INK, anchor="start", weight="normal", style="normal"):
    """Words at (x, y); a part between tildes is a subscript, as in n~0~."""
    out, lower = [], False
    for piece in words.split("~"):
        if lower:
            down = f'<tspan dy="4" font-size="{size - 3}">{piece}</tspan>'
            out.append(down + '<tspan dy="-4">\u200b</tspan>')
        else:
            out.append(piece)
        lower = not lower
    parts.append(
        f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{colour}" text-anchor="{anchor}" '
        f'font-weight="{weight}" font-style="{style}">{"".join(out)}</text>'
    )


def line(points, colour=EDGE, width=1.5, fill="none", dash=None, close=False):
    at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    kind = "polygon" if close else "polyline"
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    parts.append(
        f'<{kind} points="{at}" fill="{fill}" stroke="{colour}" stroke-width="{width}"'
        f' stroke-linejoin="round"{dashes}/>'
    )


def circle(x, y, radius, colour=INK, fill="none", width=1.5):
    parts.append(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{fill}" stroke="{colour}"'
        f' stroke-width="{width}"/>'
    )


def head(x, y, dx, dy, colour):
    length = (dx * dx + dy * dy) ** 0.5
    dx, dy = dx / length, dy / length
    back, half = 9, 4
    line(
        [(x, y), (x - back * dx + half * dy, y - back * dy - half * dx),
         (x - back * dx - half * dy, y - back * dy + half * dx)],
        colour, 1, colour, close=True,
    )


def arrow(x, y, dx, dy, colour=INK, width=2.2):
    """From (x, y) by (dx, dy), dy positive up the page."""
    end = (x + dx, y - dy)
    length = (dx * dx + dy * dy) ** 0.5
    stop = (end[0] - 6 * dx / length, end[1] + 6 * dy / length)
    line([(x, y), stop], colour, width)
    head(end[0], end[1], dx, -dy, colour)


def arc(x, y, radius, start, stop, colour=INK, width=1.5, tip=False):
    """Angles in degrees, counted from the page's right, positive towards up."""
    n = max(2, int(abs(stop - start)))
    at = [start + (stop - start) * i / n for i in range(n + 1)]
    line([(x + radius * cos(radians(a)), y - radius * sin(radians(a))) for a in at], colour, width)
    if tip:
        way = 1 if stop > start else -1
        a = radians(stop)
        head(x + radius * cos(a), y - radius * sin(a), -way * sin(a), -way * cos(a), colour)


def out_of_page(x, y, colour=INK):
    circle(x, y, 6, colour, "white")
    circle(x, y, 1.6, colour, colour)


def into_page(x, y, colour=INK):
    circle(x, y, 6, colour, "white")
    d = 4.2
    line([(x - d, y - d), (x + d, y + d)], colour)
    line([(x - d, y + d), (x + d, y - d)], colour)


def ring():
    """Panel 1: three blades, seen along the engine axis."""
    cx, cy, sector = 400, 470, 24
    text(24, 34, "1  The ring, seen along the engine axis", 16, weight="bold")

    def at(angle, radius, side=0.0):
        a = radians(angle)
        return cx + radius * sin(a) + side * cos(a), cy - radius * cos(a) + side * sin(a)

    for b in (-1, 0, 1):
        a, fill = b * sector, BLADE if b == 0 else NEIGHBOUR
        sides = [at(a, 185, -13), at(a, 318, -6), at(a, 318, 6), at(a, 185, 13)]
        line(sides, fill=fill, close=True)
        half = sector / 2 - 0.5
        outer = [at(a - half + i * half / 10, 335) for i in range(21)]
        inner = [at(a + half - i * half / 10, 318) for i in range(21)]
        line(outer + inner, fill=fill, close=True)
    line([at(a, 185) for a in range(-40, 41)], EDGE, 1.5)
    text(420, 226, "blade 0")
    text(552, 92, "blade 1, the right neighbour:")
    text(552, 110, "blade 0 turned by +2π/N.")
    text(552, 128, "Its motion lags by 2πE/N.", 14, WAVE)
    text(248, 92, "blade −1, the left neighbour:", anchor="end")
    text(248, 110, "blade 0 turned by −2π/N.", anchor="end")
    text(248, 128, "Its motion leads by 2πE/N.", 14, WAVE, "end")
    px, py = at(0, 335)
    arrow(px, py, 62, 0)
    arrow(px, py, 0, 52)
    into_page(px, py)
    text(px + 40, py - 12, "x tangential")
    text(px + 8, py - 46, "z radial")
    text(px - 12, py - 12, "y axial, away", 14, anchor="end")
    arc(cx, cy, 238, 90 + 30, 90 - 30, WAVE, 2.2, True)
    text(560, 236, "The wave travels to the right:", 14, WAVE)
    text(560, 254, "blade 1 does at t + 2πE/(Nω)", 14, WAVE)
    text(560, 272, "what blade 0 does at t.", 14, WAVE)
    arc(cx, cy, 238, 90 + 36, 90 + 54, INK, 2.2, True)
    text(24, 226, "A rotor that turns to the", 14)
    text(24, 244, "left (−x) through a fixed", 14)
    text(24, 262, "pattern of E lobes", 14)
    text(24, 280, "excites this wave.", 14)
    text(24, 304, "If it turns to the right,", 14)
    text(24, 322, "give turns: right.", 14)


def shrouds():
    """Panel 2: two shrouds in plan, seen from outside."""
    text(24, 396, "2  Two shrouds, seen from outside", 16, weight="bold")
    x0, y0, pitch, length, contact, psi = 112, 512, 146, 88, 80, radians(30)
    t, a = contact / 2 * sin(psi), contact / 2 * cos(psi)
    side = [(0, -length), (t, -a), (-t, a), (0, length)]

    def outline(shift, gap):
        right = [(x0 + shift + pitch / 2 + t_ - gap, y0 - a_) for t_, a_ in side]
        left = [(x0 + shift - pitch / 2 + t_ + gap, y0 - a_) for t_, a_ in side]
        return right + left[::-1]

    line(outline(0, 2), fill=BLADE, close=True)
    line(outline(pitch, 2), fill=NEIGHBOUR, close=True)
    text(x0 - 16, y0 - 52, "blade 0", anchor="middle")
    text(x0 + pitch + 16, y0 - 62, "blade 1", anchor="middle")
    ox, oy = x0 + pitch / 2, y0
    line([(ox, oy), (ox + 110, oy)], INK, 1, dash="4 3")
    arrow(ox, oy, 92 * cos(psi), 92 * sin(psi), V, 2.6)
    arrow(ox, oy, -74 * sin(psi), 74 * cos(psi), U, 2.6)
    out_of_page(ox, oy, W)
    arc(ox, oy, 58, 0, 30, INK, 1.5, True)
    text(ox + 64, oy - 10, "ψ", 15)
    text(ox + 88, oy - 48, "v", 16, V, weight="bold")
    text(ox - 54, oy - 58, "u", 16, U, weight="bold")
    text(ox + 2, oy + 22, "w", 16, W, weight="bold", anchor="middle")
    text(x0 - 62, y0 + 112, "contact_right of blade 0", 13)
    line([(x0 + 44, y0 + 99), (ox + 8, oy + 26)], EDGE, 1)
    text(ox + 34, y0 + 64, "contact_left", 13)
    text(ox + 34, y0 + 80, "of blade 1", 13)
    line([(ox + 44, y0 + 51), (ox + 16, oy + 20)], EDGE, 1)
    ax, ay = 338, 640
    arrow(ax, ay, 34, 0)
    arrow(ax, ay, 0, 34)
    out_of_page(ax, ay)
    text(ax + 38, ay + 5, "x")
    text(ax + 7, ay - 26, "y")
    text(ax - 74, ay + 5, "z: to you", 13)


def inclination():
    """Panel 3: cut through the contact plane that holds v and the radius."""
    text(424, 396, "3  The cut that holds v and z", 16, weight="bold")
    cx, cy, phi = 600, 520, radians(20)
    dx, h = 84 * sin(phi), 84 * cos(phi)
    top, bottom = cy - h * 0.72, cy + h * 0.72
    lean = dx * 0.72
    for edge, gap, fill in ((450, -2, BLADE), (752, 2, NEIGHBOUR)):
        face = [(cx + lean + gap, top), (cx - lean + gap, bottom)]
        line([(edge, top), *face, (edge, bottom)], fill=fill, close=True)
    text(462, bottom - 10, "blade 0")
    text(740, top + 20, "blade 1", anchor="end")
    line([(cx, cy), (cx + 116, cy)], INK, 1, dash="4 3")
    arrow(cx, cy, 96 * cos(phi), -96 * sin(phi), V, 2.6)
    arrow(cx, cy, 96 * sin(phi), 96 * cos(phi), W, 2.6)
    into_page(cx, cy, U)
    arc(cx, cy, 66, 0, -20, INK, 1.5, True)
    text(cx + 72, cy + 17, "φ", 15)
    text(cx + 96, cy + 42, "v", 16, V, weight="bold")
    text(cx + 42, cy - 82, "w", 16, W, weight="bold")
    text(cx - 20, cy + 5, "u", 16, U, weight="bold", anchor="end")
    arrow(466, cy + 14, 0, 56)
    text(474, cy - 30, "z")
    text(424, 614, "φ &gt; 0 turns v inwards: the right face", 13)
    text(424, 631, "looks towards the engine axis.", 13)
    text(424, 652, "At ψ = φ = 0: v = x, u = y, w = z.", 13)


def signs():
    """Panel 4: motion and forces."""
    text(24, 700, "4  Relative motion and forces", 16, weight="bold")
    y = 776
    line([(40, y - 40), (200, y - 40), (200, y + 40), (40, y + 40)], fill=BLADE, close=True)
    line([(300, y - 40), (460, y - 40), (460, y + 40), (300, y + 40)], fill=NEIGHBOUR, close=True)
    text(52, y - 20, "blade 0")
    text(448, y - 20, "blade 1", anchor="end")
    zig = [(200, y), (212, y)]
    zig += [(216 + 10 * i, y + (9 if i % 2 else -9)) for i in range(7)]
    line(zig + [(286, y), (300, y)], EDGE, 1.6)
    text(250, y - 16, "k~v~, k~u~", 14, anchor="middle")
    arrow(200, y + 22, -72, 0, V, 2.6)
    arrow(300, y + 22, 72, 0, V, 2.6)
    text(124, y + 27, "n", 15, V, anchor="end", weight="bold")
    text(378, y + 27, "n", 15, V, weight="bold")
    arrow(60, y + 6, 46, 0)
    text(112, y + 5, "v", 14, V, weight="bold")
    text(40, y + 62, "Faces are drawn apart. The arrows n are the forces on each blade.", 13)
    x = 490
    text(x, y - 42, "(v, u, w) = motion of the right face of blade 0", 13)
    text(x, y - 25, "less motion of the left face of blade 1.", 13)
    text(x, y - 3, "v &gt; 0 presses the faces together:", 13)
    text(x, y + 14, "n = max(n~0~ + k~v~ v, 0).  n~0~ &lt; 0 is a gap.", 13)
    text(x, y + 36, "force = (n, f~u~, f~w~) acts on blade 1 along", 13)
    text(x, y + 53, "+v, +u, +w, and on blade 0 the other way.", 13)


def page():
    """The whole drawing as text."""
    parts.clear()
    ring()
    shrouds()
    inclination()
    signs()
    for rule in ([(24, 366), (776, 366)], [(24, 670), (776, 670)], [(404, 384), (404, 656)]):
        line(rule, "#d4d9df", 1)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT}" font-family="DejaVu Sans, Arial, sans-serif">\n'
        "<title>Axes, angles, signs and the wave of a shrouded sector</title>\n"
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n'
        + "\n".join(parts) + "\n</svg>\n"
    )


if __name__ == "__main__":
    out = Path(__file__).resolve().parent.parent / "user" / "sector.svg"
    out.write_text(page(), encoding="utf-8")
