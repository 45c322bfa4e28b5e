#pragma once
// /proc, /sys and /dev of a computer, below a root: "/" for this one, a folder of invented files in tests. Reads only. Not real-time.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::apps {

class HostFiles {
public:
    explicit HostFiles(std::filesystem::path root = "/") : root_(std::move(root)) {}

    /// `path` as written on the computer, "/proc/cmdline".
    [[nodiscard]] std::filesystem::path at(std::string_view path) const { return root_ / path.substr(path.front() == '/' ? 1 : 0); }
    /// The first 1 MiB, without blanks and newlines at its end; nothing where it cannot be read.
    [[nodiscard]] std::optional<std::string> text(std::string_view path) const;
    /// The first number in it; nothing where there is none.
    [[nodiscard]] std::optional<double> number(std::string_view path) const;
    /// Names in a folder, sorted; empty where there is none.
    [[nodiscard]] std::vector<std::string> names(std::string_view folder) const;
    /// The last part of where a link points; empty where there is none.
    [[nodiscard]] std::string link_name(std::string_view path) const;
    [[nodiscard]] bool exists(std::string_view path) const;
    /// By this process.
    [[nodiscard]] bool writable(std::string_view path) const;

private:
    std::filesystem::path root_;
};

/// "0,2-4" of the kernel's lists of CPUs and IRQs; what is no list is empty.
[[nodiscard]] std::vector<int> cpu_list(std::string_view text);
/// The words between blanks.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text);

}  // namespace taktwerk::apps
