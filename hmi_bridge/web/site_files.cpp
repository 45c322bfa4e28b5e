#include "hmi_bridge/web/site_files.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::hmi::web {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> content_types{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
}};

std::string_view type_of(const std::string& ending) {
    for (const auto& known : content_types)
        if (known.first == ending) return known.second;
    return {};
}

}  // namespace

Result<SiteFiles> SiteFiles::load(const std::string& folder) {
    const auto wrong = [&](std::string what) {
        return Error{"web.no_page", folder, std::move(what),
                     "Build the page (hmi_bridge/page/README.md), or name the folder that holds its index.html with --page."};
    };
    SiteFiles site;
    std::error_code failed;
    for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
        const auto type = type_of(entry->path().extension().string());
        if (type.empty() || !std::filesystem::is_regular_file(entry->symlink_status())) continue;
        const auto name = entry->path().filename().string();
        if (site.files_.size() >= most_files) return wrong(fmt::format("there are more than {} files", most_files));
        if (entry->file_size() > longest_file) return wrong(fmt::format("{} is larger than 4 MiB", name));
        std::ifstream file(entry->path(), std::ios::binary);
        site.files_["/" + name] = SiteFile{type, {std::istreambuf_iterator<char>(file), {}}};
    }
    if (failed) return wrong("the folder cannot be read: " + failed.message());
    if (site.files_.count("/index.html") == 0) return wrong("there is no index.html");
    return site;
}

const SiteFile* SiteFiles::find(std::string_view target) const {
    const auto found = files_.find(target == "/" ? "/index.html" : target);
    return found == files_.end() ? nullptr : &found->second;
}

}  // namespace taktwerk::hmi::web
