#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws run time against error from the table of box_query_benchmark_accuracy --csv.

    plot_accuracy.py TABLE.csv PICTURE.svg
"""
import csv
import math
import sys

import matplotlib

matplotlib.use('Agg')
matplotlib.rcParams['svg.hashsalt'] = 'box_query'  # equal tables give equal files
import matplotlib.pyplot as plt  # noqa: E402

# Methods in the order of the legend: beginning of the name, colour.
METHODS = [
    ('float slab', '#b8c4ce'), ('double slab', '#7d8fa0'), ('padded slab', '#47596b'),
    ('listing 1/3/5', '#f2c14e'), ('listing 2/4/6', '#e08e2b'), ('listing 8/9/10', '#a8590d'),
    ('box_query, yes or no', '#e0245e'), ('box_query, enclosed', '#b3124a'), ('box_query, rounded', '#7a0733'),
    ('double-double always', '#6fb3a2'), ('exact always', '#2c7a68'),
]
INPUTS = {'random': 'o', 'shelf': 's', 'hostile': 'D'}
PANELS = [('ray', 'Ray against one box'), ('closest', 'Ray against 64 boxes, the closest')]
NONE, MOST = 0.1, 3e6  # where no wrong answer is drawn, and the top
BEST, WORST = 0.15, 1e21  # the same of errors; the top stands for infinity and NaN


def color_of(method):
    return next(color for start, color in METHODS if method.startswith(start))


def scatter(axes, rows, value):
    """One marker an input, those of one method joined by a line."""
    for start, color in METHODS:
        points = [(float(r['ns']), value(r), INPUTS[r['input']]) for r in rows if r['method'].startswith(start)]
        points = sorted(p for p in points if p[1] is not None)
        ours = start.startswith('box_query')
        axes.plot([p[0] for p in points], [p[1] for p in points], color=color, linewidth=2.2 if ours else 0.9,
                  alpha=0.9 if ours else 0.6, zorder=3 if ours else 2)
        for ns, y, marker in points:
            axes.scatter([ns], [y], s=85 if ours else 42, marker=marker, color=color, edgecolor='white',
                         linewidth=0.8, zorder=5 if ours else 4, clip_on=False)


def wrong(row):
    count = float(row['wrong_per_million'])
    return count if count > 0 else NONE


def worst_ulps(row):
    if float(row['asked']) == 0 or row['ulps_median'] == 'nan':
        return None  # gives no t
    ulps = float(row['ulps_worst'])
    return min(ulps, WORST) if math.isfinite(ulps) else WORST


def draw(rows, picture):
    plt.rcParams.update({'font.size': 10, 'font.family': 'DejaVu Sans', 'axes.spines.top': False,
                         'axes.spines.right': False, 'axes.titlelocation': 'left'})
    figure, grid = plt.subplots(2, 2, figsize=(11.5, 8.2))
    for line, (table, title) in zip(grid, PANELS):
        chosen = [r for r in rows if r['table'] == table and r['prepared'] == 'box']
        share = chosen[0]['asked']
        left, right = line
        scatter(left, chosen, wrong)
        left.set_title(title + ': wrong answers', fontweight='bold')
        left.set_ylabel('wrong, per million' + (' (yes/no or box)' if table == 'closest' else ''))
        left.set_yscale('log')
        left.set_ylim(NONE, MOST)
        ticks = [1, 10, 100, 1e3, 1e4, 1e5, 1e6]
        left.set_yticks([NONE] + ticks, ['none of\n%s' % f'{int(share):,}'] +
                        ['1', '10', '100', '1,000', '10,000', '100,000', '1,000,000'])
        scatter(right, chosen, worst_ulps)
        right.set_title(title + ': worst error', fontweight='bold')
        right.set_ylabel('worst error of %s, ulps' % ('the range' if table == 'closest' else 't'))
        right.set_yscale('log')
        right.set_ylim(BEST, WORST)
        right.axhline(0.5, color='#7a0733', linewidth=0.8, linestyle=':', zorder=1)
        right.set_yticks([0.5, 10, 1e4, 1e8, 1e12, 1e16, WORST], ['0.5', '10', '10⁴', '10⁸', '10¹²', '10¹⁶', 'no\nbound'])
        for axes in line:
            axes.set_xscale('log')
            axes.set_xlabel('time of a query, ns (median)')
            axes.minorticks_off()
            axes.grid(True, which='major', color='#e6e6e6', linewidth=0.7)
            axes.set_axisbelow(True)
            axes.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda x, _: f'{x:,.0f}'))
    known = [m for m in METHODS if any(r['method'].startswith(m[0]) for r in rows)]
    names = {start: next(r['method'] for r in rows if r['method'].startswith(start)) for start, _ in known}
    names['box_query, rounded'] = 'box_query, rounded t or range'
    handles = [plt.Line2D([], [], color=color, linewidth=3, label=names[start]) for start, color in known]
    handles += [plt.Line2D([], [], color='#333333', marker=marker, linestyle='', label=name + ' input')
                for name, marker in INPUTS.items()]
    figure.legend(handles=handles, loc='lower center', ncol=4, frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.13, 1, 1), w_pad=3, h_pad=2)
    figure.savefig(picture, metadata={'Date': None} if picture.endswith('.svg') else None, dpi=110)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], newline='') as table:
        draw(list(csv.DictReader(table)), sys.argv[2])


if __name__ == '__main__':
    main()
