"""How all plots look: one palette that is readable without colour vision, text and grid that follow the page's
colours, and tooltips. Plots are SVG elements that a page holds inline."""
import io
import re
import textwrap
import xml.etree.ElementTree as ElementTree

import matplotlib

matplotlib.use('svg')
import matplotlib.pyplot as plt  # noqa: E402

# Okabe and Ito's colours, with a marker each.
SERIES = [('#0072b2', 'o'), ('#d55e00', 's'), ('#009e73', '^'), ('#cc79a7', 'D'), ('#56b4e9', 'v'), ('#e69f00', 'P'),
          ('#7f7f7f', 'X'), ('#882255', '*')]
OURS, THEIRS, ROBUST = '#0072b2', '#e69f00', '#009e73'
INK, GRID = '#010203', '#040506'  # replaced by the page's colours
PANEL = (4.6, 3.4)  # inches: a panel is as wide as a phone
SVG = '{http://www.w3.org/2000/svg}'

plt.rcParams.update({
    'font.size': 9, 'svg.fonttype': 'none', 'svg.hashsalt': 'raylanes', 'text.color': INK, 'axes.labelcolor': INK,
    'axes.edgecolor': INK, 'xtick.color': INK, 'ytick.color': INK, 'grid.color': GRID, 'figure.facecolor': 'none',
    'axes.facecolor': 'none', 'savefig.facecolor': 'none', 'legend.frameon': False, 'axes.spines.top': False,
    'axes.spines.right': False, 'axes.grid': True, 'axes.axisbelow': True, 'font.family': 'sans-serif'})


def panel(title, size=PANEL):
    """A figure with a title that is wrapped, above what `legend_above` adds."""
    figure, axes = plt.subplots(figsize=size, layout='constrained')
    figure.suptitle('\n'.join(textwrap.wrap(title, 56)), fontsize=10, x=0.01, ha='left')
    return figure, axes


def legend_above(axes, columns=3, **options):
    """The legend between title and plot, so that it covers no mark."""
    axes.legend(fontsize=7, loc='lower left', bbox_to_anchor=(0, 1), borderaxespad=0.2, ncols=columns,
                columnspacing=1.2, handletextpad=0.5, title_fontsize=7, alignment='left', **options)


class Tooltips:
    """Texts of a figure's marks, by the group identifiers that matplotlib writes."""

    def __init__(self, prefix):
        self.prefix, self.texts = prefix, {}

    def add(self, artist, text):
        name = f'{self.prefix}-{len(self.texts)}'
        artist.set_gid(name)
        self.texts[name] = text


def svg_of(figure, description, tooltips=None):
    """The figure as an SVG element that scales with its column, for screen readers with a description."""
    out = io.StringIO()
    figure.savefig(out, format='svg', metadata={'Date': None, 'Creator': None})
    plt.close(figure)
    ElementTree.register_namespace('', SVG[1:-1])
    ElementTree.register_namespace('xlink', 'http://www.w3.org/1999/xlink')
    root = ElementTree.fromstring(out.getvalue())
    for element in root.findall(f'{SVG}metadata'):
        root.remove(element)
    for attribute in ('width', 'height'):
        root.attrib.pop(attribute, None)
    root.set('role', 'img')
    root.set('aria-label', description)
    for group in root.iter(f'{SVG}g'):
        text = tooltips.texts.get(group.get('id')) if tooltips else None
        if text:
            group.set('class', 'mark')
            group.set('tabindex', '0')
            title = ElementTree.Element(f'{SVG}title')
            title.text = text
            group.insert(0, title)
    text = ElementTree.tostring(root, encoding='unicode')
    text = text.replace(INK, 'var(--ink)').replace(GRID, 'var(--grid)')
    prefix = re.sub(r'\W+', '-', description.lower())[:40]
    # Identifiers are unique in the page, not just in the plot.
    text = re.sub(r'(id="|href="#|url\(#)(?=[\w-])', rf'\g<1>{prefix}-', text)
    return text
