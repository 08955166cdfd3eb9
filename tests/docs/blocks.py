"""The fenced blocks of a Markdown page, with what their first line says about them (docs/build.md lists it)."""

import re

FENCE = re.compile(r"^```(.*)$")


class Block:
    def __init__(self, language, tags, line, text):
        self.language = language  # "sh"
        self.tags = tags          # {"exit": "2", "check-only": ""}
        self.line = line          # of the opening fence, from 1
        self.text = text          # with a newline at its end

    def __str__(self):
        return f"line {self.line} ({self.language})"


def blocks_of(page):
    """Blocks of a page's text, in order. Raises ValueError for a fence that is never closed."""
    blocks, opened, lines = [], None, []
    for number, line in enumerate(page.splitlines(), 1):
        fence = FENCE.match(line)
        if opened is None and fence:
            words = fence[1].split() or [""]
            tags = dict((word.split("=", 1) + [""])[:2] for word in words[1:])
            opened, lines = Block(words[0], tags, number, ""), []
        elif opened is not None and fence and not fence[1]:
            opened.text = "".join(text + "\n" for text in lines)
            blocks.append(opened)
            opened = None
        elif opened is not None:
            lines.append(line)
    if opened is not None:
        raise ValueError(f"line {opened.line}: a block that is never closed")
    return blocks


def with_text(page, block, text):
    """The page with the text of one of its blocks replaced."""
    lines = page.splitlines(keepends=True)
    end = block.line + len(block.text.splitlines())
    return "".join(lines[:block.line]) + text + "".join(lines[end:])
