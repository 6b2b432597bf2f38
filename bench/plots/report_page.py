"""The report as one page: no network, pictures and plots inline."""
import base64
import html

import scene_figures
from advice import advice, call_for
from kernel_figures import trade_panels
from plot_style import svg_of
from report_steps import ROUNDED_TESTS, name_of, title_of
from root_figures import root_panels

STYLE = '''
:root { --ink: #1b1b1b; --paper: #ffffff; --grid: #d8d8d8; --quiet: #5a5a5a; --box: #f3f5f7; color-scheme: light dark; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e8e8; --paper: #16181b; --grid: #3a3f45; --quiet: #a8adb3; --box: #20242a; } }
@media print { :root { --ink: #000; --paper: #fff; --grid: #ccc; --box: #fff; } section { break-inside: avoid-page; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.25rem; margin-top: 2.5rem; } h3 { font-size: 1rem; }
p, li { max-width: 46rem; } .quiet { color: var(--quiet); font-size: 0.9rem; }
.panels { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); gap: 1rem; }
figure { margin: 0; } figure svg, figure img { width: 100%; height: auto; display: block; }
figcaption { color: var(--quiet); font-size: 0.85rem; }
.table { overflow-x: auto; } table { border-collapse: collapse; font-size: 0.9rem; }
th, td { padding: 0.25rem 0.6rem; text-align: left; border-bottom: 1px solid var(--grid); white-space: nowrap; }
td.number { text-align: right; font-variant-numeric: tabular-nums; } code { font-size: 0.85em; }
@media (max-width: 46rem) { .table::before { content: "Scroll sideways for all columns."; color: var(--quiet);
  font-size: 0.85rem; position: sticky; left: 0; } }
.mark:focus { outline: 2px solid var(--ink); } nav { display: flex; flex-wrap: wrap; gap: 0.25rem 1rem; }
'''


def table(header, rows):
    def cell(value):
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        text = ('–' if value != value else f'{value:.3g}') if isinstance(value, float) else str(value)
        return f'<td class="number">{text}</td>' if number else f'<td>{text}</td>'
    head = ''.join(f'<th>{html.escape(name)}</th>' for name in header)
    body = ''.join(f'<tr>{"".join(cell(value) for value in row)}</tr>' for row in rows)
    return f'<div class="table"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def plots(described):
    """Plots side by side, from pairs of a description and (figure, tooltips)."""
    drawn = ''.join(f'<figure>{svg_of(figure, text, tooltips)}</figure>' for text, (figure, tooltips) in described)
    return f'<div class="panels">{drawn}</div>'


def picture(file, caption):
    data = base64.b64encode(file.read_bytes()).decode()
    return (f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}">'
            f'<figcaption>{html.escape(caption)}</figcaption></figure>')


def section(name, title, *parts):
    return f'<section id="{name}"><h2>{title}</h2>{"".join(parts)}</section>'


def machine_section(data, machine):
    yes = {True: 'yes', False: 'no'}
    rows = [(row['path'], row['isa'], row['library'], row['lanes'], yes[row['supported']], yes[row['active']])
            for row in data['isa']]
    about = (f'{machine["processor"]}, {machine["cores"]} cores, {machine["system"]}, {machine["compiler"]}, raylanes '
             f'{machine["raylanes"]} ({machine["commit"]}, {machine["build_type"]}), {machine["date"]}')
    return section('machine', 'Machine and ISA paths', f'<p>{html.escape(about)}</p>',
                   table(['ISA path', 'instruction set', 'SIMD library', 'lanes', 'runs here', 'active'], rows))


def roots_section(data):
    return section(
        'roots', 'Square roots: error against time',
        '<p>Each mark is a method. The line is the front: nothing left of it is as fast. Point at a mark for the '
        'method, its bound and its worst argument.</p>',
        plots((f'square roots on {path}', drawn) for path, drawn in root_panels(data['roots'])))


def kernels_section(data, path):
    return section(
        'kernels', f'Intersection kernels on {path}: what an error costs',
        '<p>Time of a primitive against what a test gets wrong. The exact test is at zero by definition; the rational '
        'judge confirms it. Open marks are of the grade fast.</p>', plots(trade_panels(data['kernels'], path)))


def scene_rows(data, scenes, kind):
    return [row for scene in scenes for row in data[f'{kind}-{name_of(scene)}']]


def speed_section(data, scenes):
    rows = scene_rows(data, scenes, 'trace')
    calls = [row for row in rows if row['mode'] == 'call' or row['contender'] == 'embree']
    batches = [row for row in rows if row['mode'] != 'call']
    return section(
        'speed', 'Rays a second',
        '<p>One thread. Bars are the best mode of each on the same instruction set, and whiskers the quartiles of the '
        'rounds. All answers of ours are those of exact arithmetic.</p><h3>Batches</h3>',
        plots(scene_figures.speed_panels(batches)), '<h3>One ray a call</h3>',
        plots((f'{text}, one ray a call', drawn) for text, drawn in scene_figures.speed_panels(
            [row for row in calls if row['mode'] in ('call', 'call_packed')])))


def trees_section(data, scenes):
    rows = []
    for scene in scenes:
        for row in data[f'trees-{name_of(scene)}']:
            traces = {trace['rays']: trace['mrays_per_second'] for trace in row['traces']}
            rows.append((title_of(scene), row['contender'], row['build'], 1e3 * row['build_seconds'],
                         row['bytes'] / 2**20,
                         traces.get('primary', float('nan')), traces.get('diffuse', float('nan'))))
        for row in data[f'kdtree-{name_of(scene)}']:
            if row['rays'] == 'primary':
                rows.append((title_of(scene), 'raylanes', f'k-d tree, {row["build"]}', 1e3 * row['build_seconds'],
                             row['bytes'] / 2**20, row['mrays_per_second'], float('nan')))
    counted = [(title_of(row['scene']), row['rays'], row['nodes_per_ray'], row['box_tests_per_ray'],
                row['triangle_tests_per_ray'], row['triangle_tests_per_hit'])
               for row in scene_rows(data, scenes, 'heat') if row.get('nodes_per_ray') is not None]
    return section(
        'trees', 'Trees', '<p>BVHs of each builder and the k-d tree; k-d trees trace single rays.</p>',
        table(['scene', 'library', 'builder', 'build [ms]', 'MiB', 'primary [Mrays/s]', 'diffuse [Mrays/s]'], rows),
        '<h3>What a ray costs</h3>',
        table(['scene', 'rays', 'nodes a ray', 'boxes a ray', 'triangles a ray', 'triangles a hit'], counted))


def pictures_section(data, scenes, folder):
    shown = []
    for scene in scenes:
        # The tool names heat maps by what the scene is called, which a file or scenes.tsv says.
        heat = next((folder / f'heat-{name_of(scene)}').glob('*.png'))
        shown += [picture(folder / f'picture-{name_of(scene)}.png', f'{title_of(scene)}: rendered'),
                  picture(heat, f'{title_of(scene)}: tests of each primary ray, from dark (few) to yellow (many)')]
    return section('pictures', 'Renders and heat maps', f'<div class="panels">{"".join(shown)}</div>')


def differences_section(data, scenes, folder, differences):
    shown, rows, equal = [], [], []
    for scene in scenes:
        for test in ROUNDED_TESTS.split(',')[1:]:
            file, pixels = differences(folder / f'picture-{name_of(scene)}-exact.png',
                                       folder / f'picture-{name_of(scene)}-{test}.png')
            if pixels == 0:
                equal.append(f'{title_of(scene)} ({test})')
            else:
                noun = 'pixel differs' if pixels == 1 else 'pixels differ'
                shown.append(picture(file, f'{title_of(scene)}: {pixels} {noun} with {test}'))
        for row in data[f'tests-{name_of(scene)}']:
            rows.append((title_of(scene), row['rays'], row['test'], row['mrays_per_second'], row['wrong_per_million']))
    return section(
        'rounding', 'Where a rounded test differs from the exact one',
        '<p>Pixels that differ from the exact test are ringed. Few rays of a camera come close to an edge; '
        'the kernels above are aimed at edges.</p>',
        f'<p>No pixel differs in: {html.escape(", ".join(equal))}.</p>' if equal else '',
        f'<div class="panels">{"".join(shown)}</div>' if shown else '',
        table(['scene', 'rays', 'test (fast)', 'Mrays/s', 'wrong per million'], rows))


def advice_section(data, scenes):
    rows = []
    for scene, rays, row, noise in advice(scene_rows(data, scenes, 'advice'), data['isa']):
        if row is None:
            reason = f'too noisy: ratios vary by {100 * noise:.0f} % within half of the rounds'
            rows.append((title_of(scene), rays, '–', reason, '–', float('nan')))
            continue
        call, reason = call_for(row)
        rows.append((title_of(scene), rays, f'<code>{html.escape(call)}</code>', reason, row['path'],
                     row['mrays_per_second']))
    return section('advice', 'What to use', '<p>All ISA paths and modes took turns. The fastest call is taken. Among '
                   'calls that are as fast, within 2 % in a quarter of the rounds, it is the widest path and the '
                   'default mode. Without <code>RAYLANES_PATH</code> or the option <code>path</code> calls take the '
                   'widest path that runs here. If a run is too noisy to tell, give <code>--seconds</code> more.</p>',
                   table(['scene', 'rays', 'call', 'why', 'ISA path', 'Mrays/s'], rows))


def page(data, machine, scenes, folder, differences):
    active = next(row['path'] for row in data['isa'] if row['active'])
    parts = [machine_section(data, machine), advice_section(data, scenes), roots_section(data),
             kernels_section(data, active), speed_section(data, scenes), trees_section(data, scenes),
             pictures_section(data, scenes, folder), differences_section(data, scenes, folder, differences)]
    links = ''.join(f'<a href="#{name}">{name}</a>' for name in
                    ('machine', 'advice', 'roots', 'kernels', 'speed', 'trees', 'pictures', 'rounding'))
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
            f'content="width=device-width, initial-scale=1"><title>raylanes on {html.escape(machine["processor"])}'
            f'</title><link rel="icon" href="data:,"><style>{STYLE}</style></head><body><h1>raylanes on '
            f'{html.escape(machine["processor"])}</h1><nav>{links}</nav>{"".join(parts)}</body></html>')
