// Tables are copied as text for other programs. Needs no bundle: this script is in every page as it is.
"use strict";
(() => {
  const cellsOf = (row) => [...row.cells].filter((cell) => !cell.classList.contains("bar-cell"))
    .map((cell) => cell.textContent.trim().replace(/\s+/g, " "));

  const rowsOf = (table) => [...table.rows].map(cellsOf);

  const csvCell = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

  const latexLetters = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}",
    "±": "$\\pm$", "–": "--", "°": "$^\\circ$", "<": "$<$", ">": "$>$" };
  const latexCell = (text) => text.replace(/[\\~^±–°<>]|[&%$#_{}]/g, (letter) => latexLetters[letter] ?? `\\${letter}`);

  const markdownRow = (cells) => `| ${cells.map((text) => text.replaceAll("|", "\\|")).join(" | ")} |`;

  const formats = {
    CSV: (rows) => rows.map((cells) => cells.map(csvCell).join(",") + "\n").join(""),
    LaTeX: (rows, hasHeader) => {
      const lines = rows.map((cells) => `${cells.map(latexCell).join(" & ")} \\\\`);
      if (hasHeader) lines.splice(1, 0, "\\midrule");
      const columns = "l" + "r".repeat(rows[0].length - 1);
      return [`\\begin{tabular}{${columns}}`, "\\toprule", ...lines, "\\bottomrule", "\\end{tabular}", ""].join("\n");
    },
    Markdown: (rows, hasHeader) => {
      const all = hasHeader ? rows : [rows[0].map(() => ""), ...rows];
      const rule = all[0].map((_, column) => (column === 0 ? "---" : "--:"));
      return [all[0], rule, ...all.slice(1)].map(markdownRow).join("\n") + "\n";
    },
  };

  // Browsers that give a page from disk no clipboard still copy what is selected.
  const copyBySelection = (text) => {
    const area = document.createElement("textarea");
    area.value = text;
    area.style.cssText = "position:fixed;top:0;left:0;opacity:0";
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  };

  const copy = async (text) => {
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch {
      return copyBySelection(text);
    }
  };

  const buttonFor = (table, name) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.addEventListener("click", async () => {
      const done = await copy(formats[name](rowsOf(table), table.tHead !== null));
      button.textContent = done ? "copied" : "not allowed";
      button.classList.toggle("done", done);
      setTimeout(() => {
        button.textContent = name;
        button.classList.remove("done");
      }, 900);
    });
    return button;
  };

  for (const block of document.querySelectorAll(".table")) {
    const table = block.querySelector("table");
    const buttons = document.createElement("div");
    buttons.className = "copy";
    buttons.append("Copy as", ...Object.keys(formats).map((name) => buttonFor(table, name)));
    block.querySelector(".head").append(buttons);
  }
})();
