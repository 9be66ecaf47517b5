"""Hooks of mkdocs (mkdocs.yml)."""
import re
from pathlib import Path


def on_page_markdown(markdown, page, config, files):
    """Shows the live page that scripts/docs wrote beside a document; a document names it as <!-- live: SCENE -->."""
    folder = Path(page.file.abs_src_path).parent

    def frame(match):
        name = f"live-{match[1]}.html"
        if not (folder / name).is_file():
            return ""
        return f'<iframe class="live" src="{name}" title="The live page of {match[1]}" loading="lazy"></iframe>'

    return re.sub(r"^<!-- live: ([\w-]+) -->$", frame, markdown, flags=re.MULTILINE)


def on_post_build(config):
    """The index of the search as a script too, which a page that is opened as a file can load (search_from_file.js)."""
    folder = Path(config["site_dir"]) / "search"
    index = (folder / "search_index.json").read_text()
    (folder / "search_index.js").write_text(f"window.search_index = {index};\n")
