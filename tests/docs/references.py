"""What a page points at must be there: links, files of the repository, tests by name."""

import re

LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
FILE = re.compile(r"(?<![\w./-])(?:cli|noise|sim|restore|tests|configs|scripts|docs)/[\w./-]*\w"
                  r"\.(?:h|cpp|py|json|sh|md|png|gif)\b")
TEST = re.compile(r"`([A-Z]\w+)\.([A-Z]\w+)`")


def missing_references(page_path, page, repository):
    """A line for each link, file or test that the page names and that is not there."""
    missing = []
    for link in LINK.findall(page):
        if "://" not in link and not (page_path.parent / link).exists():
            missing.append(f"link to {link}, which is not there")
    for name in FILE.findall(page):
        if not (repository / name).exists():
            missing.append(f"names {name}, which is not in the repository")
    sources = "\n".join(file.read_text() for file in sorted((repository / "tests").rglob("*.cpp")))
    for suite, test in TEST.findall(page):
        if not re.search(rf"TEST(_F|_P)?\({suite}, {test}\)", sources):
            missing.append(f"names the test {suite}.{test}, which is not there")
    return missing
