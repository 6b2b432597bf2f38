"""What the tests of the pages share: which pages there are, and what is in one."""
import pathlib
import re

FENCE = re.compile(r'^(\s*)```(\S*)\s*$')


class Block:
    """A fenced block: its page, the line of its fence, the language, the text and the lines just before it."""

    def __init__(self, page, line, language, text, before):
        self.page, self.line, self.language, self.text, self.before = page, line, language, text, before

    @property
    def name(self):
        return f'{self.page}:{self.line}'


def pages_of(root):
    """The README and all pages of docs/, relative to the root."""
    root = pathlib.Path(root)
    return [f.relative_to(root) for f in [root / 'README.md', *sorted((root / 'docs').rglob('*.md'))] if f.is_file()]


def blocks_of(page, text):
    """The fenced blocks of a page, and its lines with those of blocks left empty."""
    blocks, prose, inside = [], [], None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if inside is None and fence:
            inside = (number, fence.group(2), [], prose[-2:])
        elif inside is not None and fence:
            start, language, lines, before = inside
            blocks.append(Block(page, start, language, '\n'.join(lines) + '\n', '\n'.join(before)))
            inside = None
        elif inside is not None:
            inside[2].append(line)
        prose.append('' if inside is not None or fence else line)
    if inside is not None:
        raise ValueError(f'{page}:{inside[0]}: a block without an end')
    return blocks, prose


def all_blocks(root):
    for page in pages_of(root):
        yield from blocks_of(page, (pathlib.Path(root) / page).read_text(encoding='utf-8'))[0]


def expected_outputs(blocks):
    """What a page says that a block prints: the block of text behind it, introduced by a line with "prints"."""
    return {before.name: after.text for before, after in zip(blocks, blocks[1:])
            if before.page == after.page and after.language == 'text' and 'prints' in after.before}
