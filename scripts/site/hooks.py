"""Hooks of mkdocs (mkdocs.yml)."""
import re
from pathlib import Path


def on_page_markdown(markdown, page, config, files):
    """Shows the live page that scripts/docs wrote beside a document, in place of the picture below it; a document names it as
    <!-- live: SCENE -->."""
    folder = Path(page.file.abs_src_path).parent

    def frame(match):
        name = f"live-{match[1]}.html"
        if not (folder / name).is_file():
            return (match[2] or "").strip()
        return f'<iframe class="live" src="{name}" title="The live page of {match[1]}" loading="lazy"></iframe>'

    return re.sub(r"^<!-- live: ([\w-]+) -->$(\n!\[.*$)?", frame, markdown, flags=re.MULTILINE)


def on_post_build(config):
    """The index of the search as a script, which a page that is opened as a file can load (theme/site/search.js)."""
    index = Path(config["site_dir"]) / "search/search_index.json"
    index.with_suffix(".js").write_text(f"const search_index = {index.read_text()};\n")
    index.unlink()
