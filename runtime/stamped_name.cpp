#include "runtime/stamped_name.hpp"

#include <algorithm>
#include <cctype>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

constexpr std::string_view utc_shape = "00000000T000000.000";

std::string plain_name(std::string_view text) {
    std::string out{text};
    for (char& c : out)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return out;
}

bool has_utc_shape(std::string_view text) {
    if (text.size() != utc_shape.size()) return false;
    for (std::size_t i = 0; i < utc_shape.size(); ++i)
        if (utc_shape[i] == '0' ? std::isdigit(static_cast<unsigned char>(text[i])) == 0 : text[i] != utc_shape[i]) return false;
    return true;
}

}  // namespace

std::string utc_stamp(Duration since_1970) {
    const auto whole = std::chrono::floor<std::chrono::seconds>(since_1970);
    const std::time_t seconds = whole.count();
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}.{:03}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday, parts.tm_hour,
                       parts.tm_min, parts.tm_sec, (since_1970 - whole) / std::chrono::milliseconds{1});
}

std::string stamped_name(std::string_view machine, Duration since_1970, std::string_view what, std::string_view ending) {
    return fmt::format("{}-{}-{}{}", plain_name(machine), utc_stamp(since_1970), plain_name(what), ending);
}

bool is_stamped(std::string_view file_name, std::string_view machine, std::string_view ending) {
    const auto mine = plain_name(machine) + "-";
    return file_name.starts_with(mine) && file_name.ends_with(ending) && has_utc_shape(file_name.substr(mine.size(), utc_shape.size()));
}

void keep_newest(const std::string& folder, std::string_view machine, std::string_view ending, std::size_t most,
                 const std::string& newest) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& path : entries_of(folder))
        if (auto name = path.filename().string(); is_stamped(name, machine, ending)) names.push_back(std::move(name));
    std::sort(names.begin(), names.end());
    const auto later = std::upper_bound(names.begin(), names.end(), std::filesystem::path(newest).filename().string());
    std::rotate(names.begin(), later, names.end());
    for (std::size_t i = 0; i + most < names.size(); ++i) std::filesystem::remove(std::filesystem::path(folder) / names[i], ignored);
}

std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> all;
    std::error_code failed;
    for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) all.push_back(at->path());
    return all;
}

}  // namespace taktwerk::runtime
