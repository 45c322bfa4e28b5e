#pragma once
// Man pages and shell completion, made of the command's own options: what stands there is what it takes.

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace taktwerk::apps {

/// taktwerk.1 and one page for each command, taktwerk-COMMAND.1: name of the file, text (man(7), UTF-8). `version` stands in their foot.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> man_pages(const CLI::App& root, const std::string& version);

/// For bash: commands, their options, values that are one of a list, names of running machines behind -s, files elsewhere.
[[nodiscard]] std::string bash_completion(const CLI::App& root);

}  // namespace taktwerk::apps
