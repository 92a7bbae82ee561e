#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws times against the number of boxes from the table of box_query_benchmark_speed --csv.

    plot_speed.py TABLE.csv PICTURE.svg
"""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
matplotlib.rcParams['svg.hashsalt'] = 'box_query'  # equal tables give equal files
import matplotlib.pyplot as plt  # noqa: E402

# Who is drawn, by the beginning of the method's name: colour, name in the legend.
WHO = [
    ('box_query', '#b3124a', 'box_query'), ('Embree, triangles', '#e08e2b', 'Embree, triangles'),
    ('Embree, boxes', '#f2c14e', 'Embree, boxes'), ('Bullet', '#2c7a68', 'Bullet'), ('FCL', '#6fb3a2', 'FCL'),
    ('ODE', '#47596b', 'ODE'), ('plain scan', '#b8c4ce', 'plain scan'),
]
KINDS = {'sparse': '-', 'dense': '--'}
PANELS = [
    ('closest, 30 m', 'single', 'The closest box within 30 m, one ray a call'),
    ('any, 30 m', 'single', 'Any box within 30 m, one ray a call'),
    ('clearance of 2 m', 'single', 'The nearest box of a 2 m segment, one a call'),
    ('closest, 30 m', 'batch', 'The closest box within 30 m, in batches on one thread'),
    ('clearance of 2 m', 'batch', 'The nearest box of a 2 m segment, in batches on one thread'),
]


def chosen(rows, question, mode, kind):
    return [r for r in rows if (r['question'], r['mode'], r['workload']) == (question, mode, kind)]


def best_by_size(rows, start):
    """Number of boxes and the fastest of the ways of one method, by size."""
    best = {}
    for row in rows:
        if row['method'].startswith(start):
            boxes = int(row['boxes'])
            best[boxes] = min(float(row['ns']), best.get(boxes, float('inf')))
    return sorted(best.items())


def draw_times(axes, rows, question, mode, title):
    for kind, line in KINDS.items():
        for start, color, _ in WHO:
            points = best_by_size(chosen(rows, question, mode, kind), start)
            ours = start == 'box_query'
            axes.plot([p[0] for p in points], [p[1] for p in points], line, color=color, marker='o',
                      markersize=4 if ours else 3, linewidth=2.4 if ours else 1.2, zorder=4 if ours else 3)
    axes.set_title(title, fontweight='bold')
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_xlabel('boxes')
    axes.set_ylabel('ns a query (median)')


def draw_threads(axes, rows):
    """How many times as fast two threads are as one."""
    for kind, line in KINDS.items():
        for question, color in (('closest, 30 m', '#b3124a'), ('clearance of 2 m', '#7d8fa0')):
            points = sorted((int(r['boxes']), float(r['ratio'])) for r in chosen(rows, question, 'threads', kind)
                            if r['method'].endswith('1 thread'))
            axes.plot([p[0] for p in points], [p[1] for p in points], line, color=color, marker='o', markersize=4,
                      label=question if kind == 'sparse' else None)
    axes.set_title('box_query in batches: one thread over two', fontweight='bold')
    axes.set_xscale('log')
    axes.set_ylim(0, 2.1)
    axes.axhline(1, color='#999999', linewidth=0.8, linestyle=':')
    axes.set_xlabel('boxes')
    axes.set_ylabel('times as fast')
    axes.legend(frameon=False, fontsize=9)


def draw(rows, picture):
    plt.rcParams.update({'font.size': 9.5, 'font.family': 'DejaVu Sans', 'axes.spines.top': False,
                         'axes.spines.right': False, 'axes.titlelocation': 'left', 'axes.titlesize': 9.5})
    figure, grid = plt.subplots(2, 3, figsize=(14, 8.2))
    panels = list(grid.flat)
    for axes, (question, mode, title) in zip(panels, PANELS):
        draw_times(axes, rows, question, mode, title)
    if any(r['mode'] == 'threads' for r in rows):  # not where the machine was busy
        draw_threads(panels[-1], rows)
    else:
        draw_times(panels[-1], rows, 'any, 30 m', 'batch', 'Any box within 30 m, in batches on one thread')
    for axes in panels:
        if axes.get_yscale() == 'log':
            axes.yaxis.set_major_locator(matplotlib.ticker.LogLocator(base=10, subs=(1, 2, 5), numticks=20))
        axes.minorticks_off()
        axes.grid(True, which='major', color='#e6e6e6', linewidth=0.7)
        axes.set_axisbelow(True)
        axes.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda x, _: f'{x:,.0f}'))
        if axes.get_yscale() == 'log':
            axes.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda x, _: f'{x:,.0f}'))
    handles = [plt.Line2D([], [], color=color, linewidth=2.4, label=name) for _, color, name in WHO]
    handles += [plt.Line2D([], [], color='#333333', linestyle=line, label=kind + ' scenes')
                for kind, line in KINDS.items()]
    figure.legend(handles=handles, loc='lower center', ncol=len(handles), frameon=False)
    figure.tight_layout(rect=(0, 0.05, 1, 1), w_pad=2, h_pad=2)
    figure.savefig(picture, metadata={'Date': None} if picture.endswith('.svg') else None, dpi=110)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], newline='') as table:
        draw(list(csv.DictReader(table)), sys.argv[2])


if __name__ == '__main__':
    main()
