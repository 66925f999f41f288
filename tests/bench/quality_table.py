#!/usr/bin/env python3
"""Measures vectorizations with the shipped program and prints a Markdown table, a row a run.

  quality_table.py CLI PICTURE... [--patches N,N,...] [--high T] [--raise] [--stage NAME=VARIANT]... [--set KEY=VALUE]...
                   [--json FILE]

Each picture is vectorized, rendered to an 8-bit PNG with the defaults, and compared and validated by CLI
(a tessera-cli). Canny's upper threshold is T, the lower one in the paper's
proportion. With --raise, a picture whose features pin the mesh above the wanted number of patches gets a second row:
both thresholds doubled until the number is reached. Needs nothing but Python's own library.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

STAGES = ["features", "initial-mesh", "simplify", "curves", "colours"]
HIGH = .125  # the paper's upper threshold
LOW_SHARE = .05 / .125  # its lower one, in the same proportion
COLUMNS = (["picture", "wanted", "patches", "Canny high", "MAE", "euclid", "MAE luma", "PSNR", "SSIM", "seam", "seam p95",
            "violations"] + [s + " s" for s in STAGES] + ["total s", "MB", "kB", "kB mesh"])


def call(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if not done.stdout:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def measure(cli, picture, patches, high, extra):
    with tempfile.TemporaryDirectory() as folder:
        document, png = os.path.join(folder, "a.tessera"), os.path.join(folder, "a.png")
        made = call(cli, "vectorize", picture, "-o", document, "--patches", patches, "--set", f"cannyLow={high * LOW_SHARE}",
                    "--set", f"cannyHigh={high}", "--quiet", "--json", *extra)
        subprocess.run([cli, "render", document, "-o", png], check=True, stderr=subprocess.DEVNULL)
        errors = call(cli, "compare", picture, png, "--json")
        validation = call(cli, "validate", document, "--json")
        info = call(cli, "info", document, "--json")
    seconds = {s["stage"]: s["seconds"] for s in made["stages"]}
    return {"picture": os.path.splitext(os.path.basename(picture))[0], "wanted": patches, "patches": made["patches"],
            "Canny high": high, "MAE": errors["mae"], "euclid": errors["euclid"], "MAE luma": errors["mae_luma"],
            "PSNR": errors["psnr"], "SSIM": errors["ssim"], "seam": validation["seam_mean"],
            "seam p95": validation["seam_p95"], "violations": validation["violation_count"],
            **{s + " s": seconds[s] for s in STAGES}, "total s": made["seconds"], "MB": made["peak_rss_mb"],
            "kB": made["bytes"] / 1000, "kB mesh": info["mesh_bytes"] / 1000}


def shown(value):
    return value if isinstance(value, str) else f"{value:.0f}" if value == int(value) else f"{value:.3g}" if value < 1 \
        else f"{value:.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("pictures", nargs="+")
    parser.add_argument("--patches", default="1000,2000,4000")
    parser.add_argument("--high", type=float, default=HIGH)
    parser.add_argument("--raise", dest="lift", action="store_true")
    parser.add_argument("--stage", action="append", default=[])
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--json")
    arguments = parser.parse_args()
    extra = [x for s in arguments.stage for x in ("--stage", s)] + [x for s in arguments.set for x in ("--set", s)]
    counts = sorted((int(n) for n in arguments.patches.split(",")), reverse=True)

    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
    rows = []

    def emit(row):
        rows.append(row)
        print("| " + " | ".join(shown(row[c]) for c in COLUMNS) + " |", flush=True)

    for picture in arguments.pictures:
        high = arguments.high  # fewer patches never need lower thresholds than more
        pinned = None
        for wanted in counts:
            # A mesh that is pinned above one count is the same for every smaller one.
            row = dict(pinned, wanted=wanted) if pinned else measure(arguments.cli, picture, wanted, arguments.high, extra)
            emit(row)
            if row["patches"] <= wanted:
                continue
            pinned = row
            if not arguments.lift:
                continue
            if high > arguments.high:
                row = measure(arguments.cli, picture, wanted, high, extra)
            while row["patches"] > wanted and high < 1:
                high = min(1, 2 * high)
                row = measure(arguments.cli, picture, wanted, high, extra)
            emit(row)
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as out:
            json.dump(rows, out, indent=1)


if __name__ == "__main__":
    main()
