#pragma once
// gnuplot as a program of its own, and text in its scripts that stays text whoever wrote it.

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::apps {

/// For gnuplot's single-quoted strings: the only ones in which it carries out nothing (backticks are a shell command in double quotes) and
/// knows no escapes but the doubled quote. A text that begins with a quote gets a blank in front.
[[nodiscard]] std::string in_gnuplot_quotes(std::string_view text);
/// A file, whatever its name: "|name" would be a command to write to.
[[nodiscard]] std::string gnuplot_file(const std::string& path);

/// Runs the script, waits for its end. Errors: plot.scratch, plot.no_gnuplot, plot.gnuplot.
[[nodiscard]] Result<void> draw_with_gnuplot(const std::string& script);

/// False: errno says why.
[[nodiscard]] bool write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace taktwerk::apps
