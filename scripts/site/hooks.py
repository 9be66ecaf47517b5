"""Hooks of mkdocs (mkdocs.yml)."""
from pathlib import Path


def on_post_build(config):
    """The index of the search as a script too, which a page that is opened as a file can load (search_from_file.js)."""
    folder = Path(config["site_dir"]) / "search"
    index = (folder / "search_index.json").read_text()
    (folder / "search_index.js").write_text(f"window.search_index = {index};\n")
