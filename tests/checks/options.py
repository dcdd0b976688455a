#!/usr/bin/env python3
"""Every option and choice of the program stands in its manual and in its completion.

usage: options.py PROGRAM MANUAL COMPLETION
The program's own help texts are the source, the two others are compared with them.
"""
import re
import subprocess
import sys

program, manual_path, completion_path = sys.argv[1:]
problems = []


def output(*arguments):
    return subprocess.run(arguments, check=True, capture_output=True, text=True).stdout


def options_of(command):
    """{name: [choices]} from the lines '  -o, --name A|B' of the help text."""
    found = {}
    for match in re.finditer(r"^  (?:-\w, )?--([\w-]+)(?: (\S+))?", output(program, "help", command), re.M):
        name, argument = match.groups()
        choices = argument.split("|") if argument and "|" in argument else []
        found[name] = [choice for choice in choices if choice == choice.lower()]
    return found


def manual_sections():
    """{command: text} of the manual's sections, font changes and escapes removed."""
    text = open(manual_path).read().replace("\\-", "-").replace("\\~", " ")
    text = re.sub(r"\\f.", "", text)
    return dict(re.findall(r"^\.SS halflight (\w+)(.*?)(?=^\.S[HS] |\Z)", text, re.M | re.S))


def completion(*words):
    """What bash offers after these words; the last one is being typed."""
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _halflight; printf "%s\\n" "${COMPREPLY[@]}"'
    return output("bash", "-c", script, "bash", completion_path, *words).split()


def check(condition, problem):
    if not condition:
        problems.append(problem)


commands = re.findall(r"^  (\w+) \[?[A-Z]", output(program, "--help"), re.M)
commands.remove("help")
check(len(commands) >= 3, "the help text lists fewer than three commands")
manual = manual_sections()
check(set(completion(program, "")) >= set(commands), "completion: not all commands are offered")
for command in commands:
    options = options_of(command)
    check(len(options) >= 2, f"help {command}: no options found")
    offered = set(completion(program, command, "--"))
    expected = {"--" + name for name in options}
    check(offered == expected, f"completion of {command}: differs in {sorted(offered ^ expected)}")
    in_manual = set(re.findall(r"^\.(?:B|BR|BI) (?:-\w \", \" )?--([\w-]+)", manual.get(command, ""), re.M))
    check(in_manual == set(options) - {"help"},
          f"manual, {command}: differs in {sorted(in_manual ^ (set(options) - {'help'}))}")
    for name, choices in options.items():
        for choice in choices:
            check(choice in completion(program, command, "--" + name, ""),
                  f"completion of {command} --{name}: {choice} is missing")
            entry = re.search(rf"--{name}\b(.*?)(?=^\.TP|\Z)", manual.get(command, ""), re.M | re.S)
            check(entry and re.search(rf"\b{re.escape(choice)}\b", entry.group(1)),
                  f"manual, {command} --{name}: {choice} is missing")
for problem in problems:
    print(problem)
sys.exit(1 if problems else 0)
