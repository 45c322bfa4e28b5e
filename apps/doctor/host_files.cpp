#include "apps/doctor/host_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>

namespace taktwerk::apps {

namespace {
constexpr std::size_t most_bytes = 1024 * 1024;
constexpr int most_cpus = 4096;
}  // namespace

std::optional<std::string> HostFiles::text(std::string_view path) const {
    std::ifstream file(at(path), std::ios::binary);
    if (!file) return std::nullopt;
    std::string all;
    char some[4096];
    while (all.size() < most_bytes && (file.read(some, sizeof some) || file.gcount() > 0)) all.append(some, static_cast<std::size_t>(file.gcount()));
    if (file.bad()) return std::nullopt;  // some of /sys open and then refuse
    while (!all.empty() && (all.back() == '\n' || all.back() == ' ' || all.back() == '\0')) all.pop_back();
    return all;
}

std::optional<double> HostFiles::number(std::string_view path) const {
    const auto all = text(path);
    if (!all) return std::nullopt;
    char* end = nullptr;
    const double value = std::strtod(all->c_str(), &end);
    if (end == all->c_str()) return std::nullopt;
    return value;
}

std::vector<std::string> HostFiles::names(std::string_view folder) const {
    std::vector<std::string> all;
    std::error_code ignored;
    for (auto it = std::filesystem::directory_iterator(at(folder), ignored); !ignored && it != std::filesystem::directory_iterator{};
         it.increment(ignored))
        all.push_back(it->path().filename());
    std::sort(all.begin(), all.end());
    return all;
}

std::string HostFiles::link_name(std::string_view path) const {
    std::error_code failed;
    const auto target = std::filesystem::read_symlink(at(path), failed);
    return failed ? std::string{} : target.filename().string();
}

bool HostFiles::exists(std::string_view path) const {
    std::error_code ignored;
    return std::filesystem::exists(at(path), ignored);
}

bool HostFiles::writable(std::string_view path) const { return ::access(at(path).c_str(), W_OK) == 0; }

std::vector<int> cpu_list(std::string_view text) {
    std::vector<int> all;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
        int first = 0;
        auto read = std::from_chars(at, end, first);
        if (read.ec != std::errc{} || first < 0) return {};
        int last = first;
        if (read.ptr < end && *read.ptr == '-') {
            read = std::from_chars(read.ptr + 1, end, last);
            if (read.ec != std::errc{}) return {};
        }
        if (last < first || last >= most_cpus) return {};
        for (int cpu = first; cpu <= last; ++cpu) all.push_back(cpu);
        at = read.ptr;
        if (at < end && *at++ != ',') return {};
    }
    return all;
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> all;
    std::size_t at = 0;
    while ((at = text.find_first_not_of(" \t\n", at)) != std::string_view::npos) {
        const auto end = std::min(text.find_first_of(" \t\n", at), text.size());
        all.emplace_back(text.substr(at, end - at));
        at = end;
    }
    return all;
}

}  // namespace taktwerk::apps
