"""A hook of MkDocs: makes the reference from the public headers, and turns links into the sources into links to it.

A header's page has its comments as they stand, since they are contracts whose lines mean something, and the
declarations between them. The index of names is that of Doxygen.
"""
import html
import pathlib
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ROOT / 'include/raylanes'
LINK = re.compile(r'(!?)\[([^\]]*)\]\(([^)#\s]+)(#[^)\s]*)?\)')
BOILERPLATE = re.compile(r'#pragma once|#include|namespace raylanes \{|\}  // namespace raylanes|struct \w+;$'
                         r'|#(ifndef|define) RAYLANES_RAYLANES_(TYPES_)?H')
KINDS = ('class', 'struct', 'enum', 'function', 'variable', 'typedef', 'concept')
made = tempfile.TemporaryDirectory()


def headers():
    return sorted(HEADERS.glob('*.h*'), key=lambda f: f.name)


def page_of(header):
    """raylanes.hpp and raylanes.h have pages of their own."""
    return header.stem + ('_c' if header.suffix == '.h' else '') + '.md'


def shown_lines(header):
    """The header's lines and their numbers, without what a reader does not ask for."""
    is_detail = False
    for number, line in enumerate(header.read_text(encoding='utf-8').splitlines(), 1):
        is_detail = is_detail or line == 'namespace detail {'
        if not is_detail and not BOILERPLATE.match(line):
            yield number, line
        is_detail = is_detail and line != '}  // namespace detail'


def body_of(header, anchor):
    """Comments at the beginning of a line as text, all between them as code; each line has an anchor."""
    page, kind = [], None
    for number, line in shown_lines(header):
        wanted = 'contract' if line.startswith('//') else 'declaration' if line.strip() else kind
        if wanted != kind:
            page += [*(['</code></pre>', ''] if kind else []), f'<pre class="{wanted}"><code>']
            kind = wanted
        shown = line.lstrip('/').removeprefix(' ') if kind == 'contract' else line
        page.append(f'<a id="{anchor}-{number}"></a>' + html.escape(shown.strip('\n')))
    return [*page, '</code></pre>', '']


def headers_of_bases(header):
    """The other headers that declare what the header's classes derive from, and what these derive from."""
    heads = ' '.join(re.findall(r'^class \w+ : ([^{;]*)\{', header.read_text(encoding='utf-8'), re.MULTILINE))
    found = []
    for base in re.findall(r'public (\w+)', heads):
        for other in headers():
            text = other.read_text(encoding='utf-8')
            if other != header and re.search(rf'^class {base}\b[^;{{]*{{', text, re.MULTILINE):
                found += [f for f in [other, *headers_of_bases(other)] if f not in [header, *found]]
    return found


def header_page(header):
    """The header, then those of its bases, so that a class's page has all its calls."""
    page = [f'# <raylanes/{header.name}>', '', *body_of(header, 'line')]
    for base in headers_of_bases(header):
        page += [f'## Inherited, from <raylanes/{base.name}>', '', *body_of(base, base.stem)]
    return '\n'.join(page)


def names_of_headers():
    """(name, kind, header, line) of what the headers declare in raylanes."""
    settings = {'INPUT': str(HEADERS), 'GENERATE_HTML': 'NO', 'GENERATE_LATEX': 'NO', 'QUIET': 'YES',
                'GENERATE_XML': 'YES', 'EXTRACT_ALL': 'YES', 'WARNINGS': 'NO', 'EXCLUDE_SYMBOLS': '*detail*'}
    with tempfile.TemporaryDirectory() as folder:
        lines = ''.join(f'{name} = {value}\n' for name, value in (settings | {'OUTPUT_DIRECTORY': folder}).items())
        subprocess.run(['doxygen', '-'], input=lines, text=True, check=True, stdout=subprocess.DEVNULL)
        for file in sorted(pathlib.Path(folder, 'xml').glob('*.xml')):
            if file.name == 'index.xml':
                continue
            for compound in ElementTree.parse(file).iter('compounddef'):
                yield from names_of_compound(compound)


def names_of_compound(compound):
    scope, kind = compound.findtext('compoundname'), compound.get('kind')
    if kind == 'file' and scope in ('raylanes.h', 'raylanes_scenes.h', 'raylanes_scenes_d.h', 'raylanes_types.h'):
        kind = 'namespace'  # as it were
    elif kind not in ('class', 'struct', 'namespace', 'concept') or not scope.startswith('raylanes'):
        return
    members = compound.iter('memberdef')
    if kind != 'namespace':
        yield scope.removeprefix('raylanes::'), kind, compound.find('location')
        members = (m for m in members if m.get('kind') == 'function' and m.get('prot') == 'public')
    for member in members:
        name = member.findtext('name')
        if name and not name.startswith(('operator', '~', '@')):
            inner = '' if kind == 'namespace' else scope.removeprefix('raylanes::') + '::'
            yield inner + name, member.get('kind'), member.find('location')


def index_page():
    rows = {}
    for name, kind, place in names_of_headers():
        if kind in KINDS and place is not None:
            header = pathlib.Path(place.get('file')).name
            rows.setdefault(name, {}).setdefault((kind, header), place.get('line'))
    page = ['# Reference', '', 'The public headers, their contracts as they stand at the declarations:', '']
    page += [f'- [`<raylanes/{h.name}>`]({page_of(h)}): {first_sentence(h)}' for h in headers()]
    page += ['', '## Names', '', '| name | what | header |', '|---|---|---|']
    for name, places in sorted(rows.items(), key=lambda row: row[0].lower()):
        for (kind, header), line in places.items():
            page.append(f'| `{name}` | {kind} | [{header}]({page_of(pathlib.PurePath(header))}#line-{line}) |')
    if not rows:
        raise RuntimeError('Doxygen found no names in the headers')
    return '\n'.join([*page, ''])


def first_sentence(header):
    text = ' '.join(line[3:] for line in header.read_text(encoding='utf-8').split('\n#')[0].splitlines())
    return re.split(r'(?<=[.:])\s', text)[0]


def on_files(files, config):
    folder = pathlib.Path(made.name, 'reference')
    folder.mkdir(exist_ok=True)
    (folder / 'index.md').write_text(index_page(), encoding='utf-8')
    for header in headers():
        (folder / page_of(header)).write_text(header_page(header), encoding='utf-8')
    for page in sorted(folder.glob('*.md')):
        files.append(File(f'reference/{page.name}', made.name, config['site_dir'], config['use_directory_urls']))
    for file in [f for f in files if f.src_path.startswith('book/')]:
        files.remove(file)
    return files


def on_page_markdown(markdown, page, **_):
    """Links that leave docs/: to the reference if they are public headers, else without a link."""
    folder = (ROOT / 'docs' / page.file.src_path).parent
    up = '../' * page.file.src_path.count('/')

    def turned(match):
        image, text, target, anchor = match.groups()
        if image or '://' in target or page.file.src_path.startswith('reference/'):
            return match.group(0)
        file = (folder / target).resolve()
        if file.is_relative_to(ROOT / 'docs'):
            return match.group(0)
        if file.parent == HEADERS:
            return f'[{text}]({up}reference/{page_of(file)}{anchor or ""})'
        return f'`{file.relative_to(ROOT)}`' if text == file.name else text
    return LINK.sub(turned, markdown)
