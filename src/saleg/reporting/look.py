"""Frame and look of the page of a report."""

#: The page; braces that stand for themselves are doubled.
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
:root {{ color-scheme: light dark; --ink: #1d2126; --paper: #fff; --line: #d9dde3; }}
@media (prefers-color-scheme: dark) {{
  :root {{ --ink: #e4e7eb; --paper: #15181c; --line: #3a4048; }}
}}
@media print {{ :root {{ --ink: #000; --paper: #fff; }} section {{ break-inside: avoid; }} }}
* {{ box-sizing: border-box; }}
body {{ margin: 0 auto; padding: 1rem; max-width: 70rem; color: var(--ink);
  background: var(--paper); font: 1rem/1.5 system-ui, sans-serif; overflow-wrap: break-word; }}
h1 {{ font-size: 1.6rem; line-height: 1.2; margin: 0.4em 0 0.2em; }}
h2 {{ font-size: 1.15rem; margin: 0 0 0.5em; }}
h3 {{ font-size: 1rem; font-weight: 600; margin: 0.8em 0 0.2em; }}
p {{ margin: 0.4em 0; max-width: 46rem; }}
section {{ border-top: 1px solid var(--line); padding: 1rem 0; }}
ul {{ margin: 0.4em 0; padding-left: 1.2em; }}
.grid {{ display: grid; gap: 1rem 2rem; align-items: start;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); }}
.pictures {{ grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); }}
figure {{ margin: 0; min-width: 0; max-width: 34rem; }}
figure svg {{ display: block; width: 100%; height: auto; }}
figure.wide {{ max-width: 52rem; }}
figure.small {{ max-width: 19rem; }}
figcaption, footer, .faint {{ font-size: 0.85rem; opacity: 0.75; }}
table {{ max-width: 100%; }}
table.heat {{ border-collapse: collapse; font-size: 0.85rem; }}
table.heat th {{ font-weight: 500; text-align: left; padding: 0.2rem 0.4rem 0.2rem 0; }}
table.heat thead th {{ writing-mode: vertical-rl; transform: rotate(180deg);
  white-space: nowrap; padding: 0.3rem 0.1rem 0.1rem; }}
table.heat thead th:first-child {{ writing-mode: initial; transform: none; }}
table.heat td {{ text-align: right; white-space: nowrap; min-width: 2.6rem; padding: 0.25rem 0.3rem;
  border: 1px solid var(--paper); font-variant-numeric: tabular-nums; }}
@media (max-width: 30rem) {{
  table.heat, table.heat th, table.heat td {{ font-size: 0.74rem; min-width: 0; }}
  table.heat td {{ padding: 0.25rem 0.15rem; }}
}}
figure td:last-child, section > table td:last-child, .grid td:last-child {{ min-width: 4em; }}
pre {{ overflow-x: auto; font-size: 0.8rem; white-space: pre-wrap; }}
summary {{ cursor: pointer; }}
</style>
</head>
<body>
{body}
<footer><p>Written by saleg {version}.</p></footer>
</body>
</html>
"""
