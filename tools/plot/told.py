"""The story of a flight on its picture: a numbered mark for each event, and beside the picture a page that says it.

Pointed at, a mark says its sentence: by the mouse, or by Tab and the arrow keys. The page needs no network and no program.
"""
import html
from pathlib import Path

import story

COLOURS = {"takeoff": "#0f766e", "landed": "#0f766e", "land": "#0f766e", "airborne": "#5b6b79", "command": "#6d28d9", "up": "#b45309", "down": "#b45309",
           "doubt": "#c8102e", "limit": "#8a5300", "out": "#8a5300", "state": "#8a5300"}
ROWS, NEAR = 3, 0.017       # of the picture's width: closer marks stand in another row
TOP, ROW = 0.985, 0.06      # of the axis's height

PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<style>
body {{ font: 15px/1.45 system-ui, sans-serif; margin: 1rem auto; max-width: {width}px; color: #14202b; background: #fff; padding: 0 .5rem; }}
figure {{ position: relative; margin: 0; }} img {{ width: 100%; display: block; }}
figure button {{ position: absolute; width: 22px; height: 22px; margin: -11px 0 0 -11px; padding: 0; border: 0; border-radius: 50%; background: transparent; cursor: pointer; }}
figure button:is(:hover, :focus) {{ outline: 3px solid #0f766e; }}
#said {{ min-height: 1.5em; padding: .5rem .7rem; background: #eef1f4; border-radius: 8px; position: sticky; top: 0; }}
li.pointed {{ background: #d7f0ec; }}
</style>
<h1>{title}</h1>
<p id="said" role="status">Point at a mark, or press Tab and the arrow keys: it says what happened.</p>
<figure><img src="{picture}" alt="{title}"><div role="group" aria-label="What happened">
{marks}
</div></figure>
<ol>
{sentences}
</ol>
<script>
const marks = [...document.querySelectorAll('figure button')], said = document.getElementById('said'), items = [...document.querySelectorAll('li')];
marks.forEach((mark, i) => {{
  const tell = () => {{ said.textContent = mark.getAttribute('aria-label'); items.forEach((item, k) => item.classList.toggle('pointed', k === i)); }};
  mark.tabIndex = i === 0 ? 0 : -1;
  mark.onmouseenter = mark.onclick = tell;
  mark.onfocus = () => {{ marks.forEach((other) => (other.tabIndex = other === mark ? 0 : -1)); tell(); }};
  mark.onkeydown = (event) => {{
    const to = {{ ArrowRight: i + 1, ArrowLeft: i - 1, Home: 0, End: marks.length - 1 }}[event.key];
    if (to !== undefined) {{ event.preventDefault(); marks[Math.min(Math.max(to, 0), marks.length - 1)].focus(); }}
  }};
}});
</script>
</html>
"""


def placed(events, span):
    """(event, row) of those within the span."""
    ends, width = [-1.0] * ROWS, span[1] - span[0]
    for event in events:
        if not span[0] <= event[0] <= span[1]:
            continue
        at = (event[0] - span[0]) / width
        row = next((k for k in range(ROWS) if at - ends[k] >= NEAR), 0)
        ends[row] = at
        yield event, row


def draw(axis, rec, span):
    """Draws the marks; [(x, y as parts of the picture from its upper left, event)]."""
    found = []
    for number, (event, row) in enumerate(placed(story.story(rec), span), 1):
        t, kind, _ = event
        height = TOP - row * ROW
        axis.axvline(t, ymax=height, color=COLOURS[kind], linewidth=0.8, linestyle=":")
        axis.text(t, height, str(number), transform=axis.get_xaxis_transform(), ha="center", va="center", fontsize=7.5, color="white", fontweight="bold",
                  bbox={"boxstyle": "circle,pad=0.25", "facecolor": COLOURS[kind], "edgecolor": "white", "linewidth": 0.8}, zorder=5)
        found.append((t, height, event))
    return found


def places(figure, axis, found):
    """Where the marks are, when the figure has its last size."""
    wide, high = figure.canvas.get_width_height()
    for t, height, event in found:
        x, y = axis.get_xaxis_transform().transform((t, height))
        yield x / wide, 1.0 - y / high, event


def write(picture, title, width, at):
    """The page beside the picture; its path."""
    marks, sentences = [], []
    for x, y, (t, kind, text) in at:
        said = html.escape(f"{t:.1f} s: {text}")
        marks.append(f'<button data-kind="{kind}" style="left:{100 * x:.2f}%;top:{100 * y:.2f}%" aria-label="{said}"></button>')
        sentences.append(f"<li>{said}</li>")
    path = Path(picture).with_suffix(".html")
    path.write_text(PAGE.format(title=html.escape(title), picture=html.escape(Path(picture).name), width=width, marks="\n".join(marks), sentences="\n".join(sentences)),
                    encoding="utf-8")
    return path
