"""What MkDocs does not do by itself: pages that lie outside of docs/, links to sources, and the navigation.

The first page is README.md, the navigation is the list of docs/pages.md: neither is written twice. With FLY=URL in the environment
the site offers the browser page there (make publish).
"""
import os
import re
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
OUTSIDE = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "drivers/README.md": "driver.md",
           "course/README.md": "course.md", "examples/one_ray/README.md": "one_ray.md",
           **{f"course/{path.parent.name}/README.md": f"course_{path.parent.name}.md" for path in (ROOT / "course").glob("*/README.md")}}
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")
FLY_NOW = {"en": ("Fly now", "The simulated vehicle, in this browser", "nothing to install"),
           "es": ("Vuela ahora", "El vehículo simulado, en este navegador", "sin instalar nada")}


def place_of(path):
    """Where a file of the repository lies in the site's sources."""
    if path in OUTSIDE:
        return OUTSIDE[path]
    return path[len("docs/"):] if path.startswith("docs/") else f"source/{path}"


def path_of(place):
    return next((path for path, name in OUTSIDE.items() if name == place), f"docs/{place}")


def target_of(page, link):
    """The path in the repository that a link of a page leads to; None: it leads out of it."""
    if re.match(r"\w+:", link):
        return None
    return os.path.normpath(os.path.join(os.path.dirname(page), link))


def relinked(page, text):
    def turn(found):
        target = target_of(page, found.group(2))
        if target is None:
            return found.group(0)
        link = os.path.relpath(place_of(target), os.path.dirname(place_of(page)) or ".")
        return f"{found.group(1)}{link}{found.group(3) or ''}{found.group(4)}"
    return LINK.sub(turn, text)


def spoken(diagram):
    """A mermaid flowchart as a list of its ways, which needs no program from elsewhere, and can be read aloud."""
    node = r"(\w+)(?:[\[({]+([^\])}]+)[\])}]+)?"
    names = {name: text for name, text in re.findall(node, diagram) if text}
    ways = []
    for line in diagram.splitlines():
        parts = re.split(r"\s*(?:--+>(?:\|([^|]*)\|)?|-\.(.*?)\.->)\s*", line.strip())
        if len(parts) > 1:
            steps = [names.get(name, name) for name in (re.match(node, part).group(1) for part in parts[::3])]
            labels = [f" *({plain or dotted})*" if plain or dotted else "" for plain, dotted in zip(parts[1::3], parts[2::3])]
            ways.append("- " + steps[0] + "".join(f" →{label} {step}" for label, step in zip(labels, steps[1:])))
    return "\n".join(ways)


def sources_linked():
    """The files that are no pages and lie outside of docs/, but that a page links."""
    for page in [*OUTSIDE, *(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md"))]:
        for found in LINK.finditer((ROOT / page).read_text(encoding="utf-8")):
            target = target_of(page, found.group(2))
            if target and place_of(target).startswith("source/") and (ROOT / target).is_file():
                yield target


def navigation():
    """[{section: [place, ...]}, ...] of docs/pages.md."""
    sections = [{"Plomada": ["index.md", "pages.md"]}]
    for title, body in re.findall(r"^## (.*)\n((?:(?!## ).*\n)*)", (ROOT / "docs/pages.md").read_text(encoding="utf-8"), re.MULTILINE):
        places = [place_of(target_of("docs/pages.md", link)) for _, link, _, _ in LINK.findall(body)]
        sections.append({title: list(dict.fromkeys(places))})
    return sections


def on_config(config):
    config["nav"] = navigation()
    return config


def on_files(files, config):
    for path, place in OUTSIDE.items():
        files.append(File.generated(config, place, content=(ROOT / path).read_text(encoding="utf-8")))
    for path in sorted(set(sources_linked())):
        files.append(File.generated(config, place_of(path), abs_src_path=str(ROOT / path)))
    return files


def on_page_markdown(markdown, page, config, files):
    path = path_of(page.file.src_uri)
    text = re.sub(r"```mermaid\n(.*?)```", lambda diagram: spoken(diagram.group(1)), relinked(path, markdown), flags=re.DOTALL)
    if os.environ.get("FLY") and path in ("README.md", "docs/ground.md", "docs/es/index.md"):
        up = "../" * page.file.src_uri.count("/")
        title, _, rest = text.partition("\n")
        now, vehicle, nothing = FLY_NOW["es" if path.startswith("docs/es/") else "en"]
        text = f'{title}\n\n!!! tip "{now}"\n    [{vehicle}]({up}{os.environ["FLY"]}){{ target="_blank" }}: {nothing}.\n{rest}'
    return text
