"""Hooks of mkdocs (mkdocs.yml)."""
import re
from pathlib import Path


def on_page_markdown(markdown, page, config, files):
    """Shows the live page that scripts/docs wrote beside a document, in place of the picture below it; a document names it as
    <!-- live: SCENE -->. Shows the tables of the program that a document names as <!-- tables: NAME -->."""
    folder = Path(page.file.abs_src_path).parent

    def frame(match):
        name = f"live-{match[1]}.html"
        if not (folder / name).is_file():
            return (match[2] or "").strip()
        return f'<iframe class="live" src="{name}" title="The live page of {match[1]}" loading="lazy"></iframe>'

    def tables(match):
        """A section of `noonmark settings --html` (scripts/docs writes it), with its headings as those of the document."""
        page = Path(config["docs_dir"]).parent / "tables.html"
        if not page.is_file():
            return "*`noonmark settings --html` prints these tables; the program was not there when this site was made.*"
        section = re.search(rf'<section id="{match[1]}"><h2>.*?</h2>\n(.*?)</section>', page.read_text(), re.S)[1]
        return re.sub(r"<h3[^>]*>(.*?)</h3>", r"\n## \1\n", section)

    markdown = re.sub(r"^<!-- tables: ([\w-]+) -->$", tables, markdown, flags=re.MULTILINE)
    return re.sub(r"^<!-- live: ([\w-]+) -->$(\n!\[.*$)?", frame, markdown, flags=re.MULTILINE)


def on_post_build(config):
    """The index of the search as a script, which a page that is opened as a file can load (theme/site/search.js)."""
    index = Path(config["site_dir"]) / "search/search_index.json"
    index.with_suffix(".js").write_text(f"const search_index = {index.read_text()};\n")
    index.unlink()
