"""Words of pages and comments: bounded sentences, no banned phrase, links that lead somewhere."""

from __future__ import annotations

import ast
import importlib.util
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs/pages"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.rglob("*.md"))]
BOUNDED = [
    *PAGES,
    ROOT / "CHANGELOG.md",
    ROOT / "tests/README.md",
    ROOT / "tests/bench/README.md",
    *sorted((ROOT / "tests/validation").glob("*.md")),
]
MOST_WORDS = 35
MOST_WORDS_OF_A_DOCSTRING = 30
MOST_WORDS_OF_A_COMMENT = 25

# What a stranger could not understand without the author, and figures of speech in the place of a term.
BANNED = (
    "as all its nodes together will have it",
    "what an error is divided into may be nil",
    "arrive together by all but a hair",
    "by all but a hair",
    "may be nil",
    "in the stead of",
    "hangs on signs and sizes",
    "has any say",
    "its own affair",
)
TEXT_FILES = [
    path
    for folder in ("cpp", "bindings", "python", "docs", "examples", "tests/bench")
    for path in sorted((ROOT / folder).rglob("*"))
    if path.suffix in {".hpp", ".cpp", ".py", ".md"}
] + PAGES[:2]


def sentences(markdown: str) -> list[str]:
    """Sentences of the running text; a list item, a cell of a table and a heading end one each."""
    text = re.sub(r"^(`{3,}|~{3,}).*?^\1\s*$", "\n\n", markdown, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"^:::.*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`\n]*`", "code", text)
    text = re.sub(r"^\s*(?:[-*]|\d+\.)\s+", "\n\n", text, flags=re.MULTILINE)
    text = re.sub(r"^#.*$", "\n\n", text, flags=re.MULTILINE)
    text = re.sub(
        r"^\|(.*)\|$", lambda row: "\n\n" + row.group(1).replace("|", "\n\n"), text, flags=re.MULTILINE
    )
    found = []
    for paragraph in re.split(r"\n\s*\n", text):
        found += re.split(r"(?<=[.!?])[\"*)]*\s+(?=[A-Z*\"(]|code\b)", " ".join(paragraph.split()))
    return [sentence for sentence in found if sentence]


def words(sentence: str) -> int:
    """Number of words; numbers and signs alone are none."""
    return len(re.findall(r"[A-Za-z][\w'’-]*", sentence))


@pytest.mark.parametrize("page", BOUNDED, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_no_sentence_is_too_long(page: Path) -> None:
    long = [s for s in sentences(page.read_text(encoding="utf-8")) if words(s) > MOST_WORDS]
    assert not long, "\n".join(f"{words(s)} words: {s}" for s in long)


def test_length_of_sentences_is_counted() -> None:
    text = f"One two. W{'ord w' * 36}ord.\n\n- an item\n- {'word ' * 36}\n\n```\n{'code ' * 50}\n```\n"
    assert [words(s) for s in sentences(text)] == [2, 37, 2, 36]
    assert words("See code, 0.5 m, and 3 more.") == 5


def sentences_of_docstring(docstring: str) -> list[str]:
    """Sentences of a docstring in NumPy's style; a semicolon and the name of a field end one, too."""
    text = re.sub(r"^=+( +=+)+$.*^=+( +=+)+$", "", docstring, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"^.*\n *-{3,}$", "", text, flags=re.MULTILINE)
    text = re.sub(r"^(?=\S).*\n(?= )", "\n", text, flags=re.MULTILINE)
    text = re.sub(r":(?:\w+:)?``?[^`]*``?|``[^`]*``", "code", text)
    return [
        part for sentence in sentences(text) for part in re.split(r"; (?=\w)|(?<=\.) (?=\w+: )", sentence)
    ]


def docstrings(tree: ast.Module) -> list[str]:
    """All texts that stand alone: docstrings of modules, classes, functions and attributes."""
    return [
        inspect.cleandoc(node.value.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    ]


def test_no_sentence_of_a_docstring_is_too_long() -> None:
    long = [
        f"{path.relative_to(ROOT)}: {words(sentence)} words: {sentence}"
        for path in sorted((ROOT / "python/birm3d").rglob("*.py"))
        for docstring in docstrings(ast.parse(path.read_text(encoding="utf-8")))
        for sentence in sentences_of_docstring(docstring)
        if words(sentence) > MOST_WORDS_OF_A_DOCSTRING
    ]
    assert not long, "\n".join(long)


def test_sentences_of_docstrings_are_found() -> None:
    head = "Return it.\n\nParameters\n----------\n"
    text = head + f"x : str\n    {'word ' * 36}; and\n    more.\ny\n    Two words."
    module = ast.parse(f'def f():\n    """{text}"""\n')
    found = [words(s) for d in docstrings(module) for s in sentences_of_docstring(d)]
    assert found == [2, 36, 2, 2]


def phrases_in(text: str) -> list[str]:
    """Banned phrases of a text, whatever the line breaks and comment signs between their words."""
    plain = " ".join(re.sub(r"^\s*(//+|#)", " ", text, flags=re.MULTILINE).lower().split())
    return [phrase for phrase in BANNED if re.search(rf"\b{re.escape(phrase)}\b", plain)]


def test_no_banned_phrase() -> None:
    found = {
        path.relative_to(ROOT).as_posix(): phrases
        for path in TEXT_FILES
        if (phrases := phrases_in(path.read_text(encoding="utf-8")))
    }
    assert not found, found


def test_banned_phrases_are_found_across_lines() -> None:
    assert phrases_in("// A wheel turns as all its nodes\n// together will have it.") == [BANNED[0]]
    assert phrases_in("x = 1  # many say\n") == []


@pytest.fixture(scope="module")
def source_links() -> ModuleType:
    """The site's own finder of files and symbols, so that this test and the site agree."""
    spec = importlib.util.spec_from_file_location("source_links", ROOT / "docs/build/source_links.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_pages_name_files_and_functions_that_exist(source_links: ModuleType) -> None:
    """A renamed or moved function must be mended on the page that names it, docs/pages/*.md."""
    wrong, count = [], 0
    for page in PAGES[2:]:
        for _, target, symbol in source_links.links_of(page):
            count += 1
            try:
                source_links.resolved(page, target, symbol)
            except ValueError as error:
                wrong.append(str(error))
    assert not wrong, "\n".join(wrong)
    assert count > 100


@pytest.mark.parametrize("page", PAGES[:2], ids=lambda page: page.name)
def test_links_of_other_pages(page: Path) -> None:
    targets = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    assert targets
    assert [t for t in targets if "://" not in t and not (page.parent / t).exists()] == []


def test_the_whole_check_runs_the_command_of_the_readme() -> None:
    readme, check = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", ".ci/run"))
    commands = re.findall(r"^python3 -m venv .*$", readme, flags=re.MULTILINE)
    assert len(commands) == 2
    assert re.findall(r"^test_command='(.*)'$", check, flags=re.MULTILINE) == commands[1:]


def test_a_wrong_link_is_found(source_links: ModuleType) -> None:
    page = DOCS / "theory.md"
    with pytest.raises(ValueError, match="no file"):
        source_links.resolved(page, "../../cpp/none.cpp", None)
    with pytest.raises(ValueError, match="does not define no_such_function"):
        source_links.resolved(page, "../../cpp/src/kernels/impulse.cpp", "no_such_function")
    text = "// f(x)\nvoid g() {\n    f(1);\n}\ndouble f(double x) {\n}\n"
    assert source_links.line_of(text, "f") == 5


IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
CPP_FILES = sorted(p for top in ("cpp", "bindings") for p in (ROOT / top).rglob("*.?pp"))


def comments_and_code(text: str) -> tuple[list[tuple[int, str]], str]:
    """Comments of a C++ file with their lines, and what is left of the file."""
    comments, code = [], []
    for number, line in enumerate(text.splitlines(), 1):
        head, _, comment = re.sub(r'"(?:[^"\\]|\\.)*"', '""', line).partition("//")
        code.append(head if comment else line)
        if comment:
            comments.append((number, comment))
    return comments, "\n".join(code)


def code_beside(path: Path, text: str) -> str:
    """Code of a C++ file, of its header or source, and of the project's headers that it includes."""
    included = re.findall(r'^#include "(.+)"', text, flags=re.MULTILINE)
    near = [p for p in CPP_FILES if p.stem == path.stem and p != path]
    near += [p for p in CPP_FILES if any(p.as_posix().endswith(f"/{name}") for name in included)]
    return "\n".join(comments_and_code(t)[1] for t in (text, *(p.read_text(encoding="utf-8") for p in near)))


def unknown_names(path: Path, text: str, calls: set[str], files: list[str]) -> list[str]:
    """What comments of a C++ file name that is not there: `names` in code beside them, calls() and files."""
    known: set[str] | None = None
    found = []
    for number, comment in comments_and_code(text)[0]:
        for quoted in re.findall(r"`([^`]+)`", comment):
            known = known or set(IDENTIFIER.findall(code_beside(path, text)))
            if not set(IDENTIFIER.findall(quoted)) <= known:
                found.append(f"{path.name}:{number}: `{quoted}`")
        for name in re.findall(r"\b([a-z]\w+)\(\)", comment):
            if name not in calls:
                found.append(f"{path.name}:{number}: {name}()")
        for name in re.findall(r"(?<![\w*])(\w[\w/]*\.(?:hpp|cpp|py|csv|toml|md))\b", comment):
            if not any(file.endswith(f"/{name}") for file in files):
                found.append(f"{path.name}:{number}: {name}")
    return found


@pytest.fixture(scope="module")
def callable_names() -> set[str]:
    """Names that C++ or Python code of the project calls or defines as functions."""
    code = [comments_and_code(p.read_text(encoding="utf-8"))[1] for p in CPP_FILES]
    code += [p.read_text(encoding="utf-8") for p in (ROOT / "python/birm3d").rglob("*.py")]
    return {name for text in code for name in re.findall(r"\b(\w+)\(", text)}


def test_comments_name_what_exists(callable_names: set[str]) -> None:
    """A renamed parameter, function or file must be mended in the comments that name it."""
    folders = ("cpp", "bindings", "python", "tests", "docs", "examples")
    files = [p.as_posix() for folder in folders for p in (ROOT / folder).rglob("*.*")]
    wrong = [
        name
        for path in CPP_FILES
        for name in unknown_names(path, path.read_text(encoding="utf-8"), callable_names, files)
    ]
    assert not wrong, "\n".join(wrong)


def test_names_in_comments_that_do_not_exist_are_found(callable_names: set[str]) -> None:
    text = "// `gone` beside `x`: see kick() and gone().\n// As base/box.hpp and base/gone.hpp say.\nint x;\n"
    path, files = ROOT / "cpp/src/kernels/nowhere.hpp", ["/cpp/base/box.hpp"]
    assert unknown_names(path, text, callable_names, files) == [
        "nowhere.hpp:1: `gone`",
        "nowhere.hpp:1: gone()",
        "nowhere.hpp:2: base/gone.hpp",
    ]


def equations_in(text: str) -> set[int]:
    """Numbers of the paper's equations that a text names: "Eq. 1", "Eq. 4, 5", "Eq. 9 to 14" or "Eq. 2-5"."""
    found: set[int] = set()
    for listed in re.findall(r"Eq\. ((?:\d+(?:, | to |-)?)+)", text):
        for first, last in re.findall(r"(\d+)(?:(?: to |-)(\d+))?", listed):
            found.update(range(int(first), int(last or first) + 1))
    return found


def test_equations_of_the_paper_are_where_the_theory_says(source_links: ModuleType) -> None:
    """Each row names files in which comments name its equations; together they have all of them, 1 to 16."""
    page = DOCS / "theory.md"
    table = page.read_text(encoding="utf-8").split("## Where each equation is")[1].split("\n## ")[0]
    known: set[int] = set()
    for row in (line for line in table.splitlines() if line.startswith("| Eq. ")):
        equations, links = equations_in(row.split("|")[1]), source_links.LINK.findall(row.split("|")[3])
        named: set[int] = set()
        for stem in {Path(source_links.resolved(page, target, None)[0]).stem for _, target, _ in links}:
            for path in (p for p in CPP_FILES if p.stem == stem):
                text = " ".join(c for _, c in comments_and_code(path.read_text(encoding="utf-8"))[0])
                named |= equations_in(text)
        assert equations, row
        assert equations <= named, row
        known |= equations
    assert known == set(range(1, 17))


def test_numbers_of_equations_are_read() -> None:
    assert equations_in("| Eq. 4, 5 | and Eq. 9 to 11, Fig. 5; Eq. 14-16, and 3") == {
        4,
        5,
        9,
        10,
        11,
        14,
        15,
        16,
    }


def names_of_module(tree: ast.Module) -> set[str]:
    """Identifiers of a module's code, and words of its texts that are no docstrings."""
    texts = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant):
            if isinstance(node.value, str) and id(node) not in texts:
                found.update(IDENTIFIER.findall(node.value))
            continue
        for field in ("id", "attr", "arg", "name", "asname"):
            if isinstance(name := getattr(node, field, None), str):
                found.update(IDENTIFIER.findall(name))
    return found


def unknown_names_of_module(source: str) -> list[str]:
    """What docstrings and comments of a module quote as `name` that its code does not have."""
    tree = ast.parse(source)
    texts = [
        re.sub(r":(?:\w+:)+`[^`]*`", "", text) for text in (*docstrings(tree), *re.findall(r"#.*", source))
    ]
    known = names_of_module(tree)
    quoted = {name for text in texts for name in re.findall(r"(?<!`)`([^`]+)`(?!`)", text)}
    commands = {name for name in quoted if name.startswith("birm3d ")}
    return sorted(name for name in quoted - commands if not set(IDENTIFIER.findall(name)) <= known)


def test_docstrings_name_what_exists() -> None:
    """A renamed argument must be mended in the texts that name it."""
    found = {
        path.relative_to(ROOT).as_posix(): names
        for path in sorted((ROOT / "python/birm3d").rglob("*.py"))
        if (names := unknown_names_of_module(path.read_text(encoding="utf-8")))
    }
    assert not found, found


def test_names_in_docstrings_that_do_not_exist_are_found() -> None:
    source = 'def f(x):\n    """See `x`, `gone`, ``code`` and :func:`role`."""\n    return x  # `old` of f\n'
    assert unknown_names_of_module(source) == ["gone", "old"]


def test_glossary_has_the_names_of_the_code() -> None:
    """The last column of each row: identifiers of C++ or Python, as they are written."""
    files = [*CPP_FILES, *sorted((ROOT / "python/birm3d").rglob("*.py"))]
    known = {name for path in files for name in IDENTIFIER.findall(path.read_text(encoding="utf-8"))}
    rows = [
        line for line in (DOCS / "glossary.md").read_text(encoding="utf-8").splitlines() if line[:1] == "|"
    ]
    names = {name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[-2])}
    assert len(names) > 80
    assert [name for name in sorted(names) if not set(IDENTIFIER.findall(name)) <= known] == []


def sentences_of_comments(source: str, sign: str = "//") -> list[str]:
    """Sentences of the comments of a file; an indented line is a formula or a table, and ends one."""
    text = ""
    for line in source.splitlines():
        code, _, comment = line.partition(sign)
        plain = not comment.startswith("  ") and not code.strip()
        text += f"{comment}\n" if plain else "\n\n"
    parts = [part for paragraph in re.split(r"\n\s*\n", text) for part in re.split(r"[.:;!?]\s", paragraph)]
    return [" ".join(part.split()) for part in parts if part.strip()]


def test_no_sentence_of_a_comment_is_too_long() -> None:
    folders = ("python/birm3d", "examples", "docs/build", "tests")
    python = sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))
    long = [
        f"{path.relative_to(ROOT)}: {words(sentence)} words: {sentence}"
        for path, sign in (*((p, "//") for p in CPP_FILES), *((p, "#") for p in python))
        for sentence in sentences_of_comments(path.read_text(encoding="utf-8"), sign)
        if words(sentence) > MOST_WORDS_OF_A_COMMENT
    ]
    assert not long, "\n".join(long)


def test_sentences_of_comments_are_found() -> None:
    source = "// One two\n// three. Four:\n//   x = y\n// five\nint x;  // six\n"
    assert sentences_of_comments(source) == ["One two three", "Four:", "five"]
    assert sentences_of_comments(source.replace("//", "#"), "#") == ["One two three", "Four:", "five"]


@pytest.mark.slow
def test_site_builds_without_warnings(tmp_path: Path) -> None:
    """Every page, table, picture and docstring; a warning is an error."""
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "-f", ROOT / "docs/mkdocs.yml", "-d", tmp_path],
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    theory = (tmp_path / "theory.html").read_text(encoding="utf-8")
    assert "source/cpp/src/kernels/impulse.cpp.html#line-" in theory
    assert "<math" in theory
    assert (tmp_path / "source/cpp/src/kernels/impulse.cpp.html").is_file()
    assert len(list((tmp_path / "pictures").glob("*.png"))) >= 7
    reference = (tmp_path / "reference/python.html").read_text(encoding="utf-8")
    assert 'id="birm3d.Vehicle.preset"' in reference
    assert "energy_residual" in (tmp_path / "reference/metrics.html").read_text(encoding="utf-8")
    assert "TrussMesh" in (tmp_path / "reference/cpp.html").read_text(encoding="utf-8")
    text = "".join(p.read_text(encoding="utf-8") for p in tmp_path.glob("*.html"))
    assert "<!-- build:" not in text
    assert not re.search(r'<(?:script|img|link)[^>]*(?:src|href)="https?://', text), (
        "a page needs the network"
    )


def test_claims_on_poles_in_the_side_name_the_speed_that_they_hold_at() -> None:
    """They were measured at one speed only."""
    for page, claims in {
        "CHANGELOG.md": ("0.85 to 1.2 times the impulse", "nothing in the last fifth before the nose"),
        "docs/pages/validation.md": ("0.85 to 1.2 times the impulse",),
    }.items():
        text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
        for claim in claims:
            before, found, _ = text.partition(claim)
            assert found, (page, claim)
            assert "14 m/s (50 km/h)" in before[-160:], (page, claim)
