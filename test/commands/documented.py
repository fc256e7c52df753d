"""The command lines that README and docs show."""
import re
import shutil

from shell import ROOT

COMMENT = re.compile(r"\s+#\s.*$")
INLINE = re.compile(r"`([^`\n]+)`")
FIRST_WORDS = ("rosrun", "roslaunch", "snakemake", "catkin_make", "catkin", "mission", "benchmark")


def documents():
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]


def code_lines(text):
    """Lines of code blocks, indented or fenced, comments left out, continued lines joined."""
    lines, begun, is_fenced = [], "", False
    for line in text.splitlines():
        if line.startswith("```"):
            is_fenced = not is_fenced
            continue
        if not (is_fenced or line.startswith("    ")):
            continue
        line = COMMENT.sub("", line).strip()
        if line.endswith("\\"):
            begun += line[:-1] + " "
        elif line:
            lines.append(re.sub(r"\s+", " ", begun + line))
            begun = ""
    return lines


def is_command(line):
    """Whether somebody could type it: it begins with a program."""
    first = line.split()[0]
    return first == "." or first.startswith("scripts/") or first in FIRST_WORDS \
        or shutil.which(first, path="/usr/local/bin:/usr/bin:/bin") is not None


def is_inline_command(span):
    """A program with arguments; a bare name in a sentence is only mentioned."""
    words = span.split()
    return len(words) > 1 and (words[0] in FIRST_WORDS or words[0].startswith("scripts/"))


def commands():
    """Every command line, each once, in the order in which they are shown."""
    found = []
    for path in documents():
        text = path.read_text(encoding="utf-8")
        found += [line for line in code_lines(text) if is_command(line)]
        found += [span for span in INLINE.findall(text) if is_inline_command(span)]
    return list(dict.fromkeys(found))


def settings():
    """Every `--set` that is shown, with all its assignments, but those that leave the value open."""
    found = []
    for path in documents():
        for span in INLINE.findall(path.read_text(encoding="utf-8")):
            if span.startswith("--set ") and "..." not in span and span != "--set key=value":
                found.append(span)
    return list(dict.fromkeys(found))
