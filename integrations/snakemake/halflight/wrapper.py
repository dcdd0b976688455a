"""Snakemake wrapper: `halflight render`, `animate`, `convert`, `looks` or `info` of the inputs."""
import os
import shlex
import subprocess

command = snakemake.params.get("command", "render")  # noqa: F821
options = shlex.split(str(snakemake.params.get("options", "")))  # noqa: F821
words = ["halflight", command, *map(str, snakemake.input)]  # noqa: F821
if command == "convert":
    words.append(str(snakemake.output[0]))  # noqa: F821
elif command != "info":
    words += ["-o", str(snakemake.output[0])]  # noqa: F821
if command == "render":
    words += ["--threads", str(snakemake.threads), "--quiet"]  # noqa: F821
log = snakemake.log[0] if snakemake.log else os.devnull  # noqa: F821
with open(log, "w") as said:
    if command == "info":
        with open(str(snakemake.output[0]), "w") as file:  # noqa: F821
            subprocess.run([*words, "--json", *options], check=True, stdout=file, stderr=said)
    else:
        subprocess.run([*words, *options], check=True, stderr=said)
