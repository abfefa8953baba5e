"""A hook of MkDocs: the sources of tests and of the site itself are no part of the site."""
from mkdocs.structure.files import Files


def on_files(files, config):
    return Files([file for file in files
                  if not file.src_uri.startswith(("tests/", "extend/examples/")) and not file.src_uri.endswith((".py", ".yml", ".1", ".bash", ".in", "CMakeLists.txt"))])
