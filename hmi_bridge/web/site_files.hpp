#pragma once
// The page's files: read once, at the start, from one folder; a request asks a table and never the disk. Not real-time.

#include <map>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::hmi::web {

struct SiteFile {
    std::string_view type;  ///< Content-Type
    std::string content;
};

class SiteFiles {
public:
    static constexpr std::size_t most_files = 64;
    static constexpr std::size_t longest_file = 4 * 1024 * 1024;

    /// Regular files that lie in `folder` itself (links and folders are passed over) and have an ending of the list. Errors: web.no_page.
    static Result<SiteFiles> load(const std::string& folder);

    /// `target`: of the request line. "/" is index.html. Null: no such file.
    [[nodiscard]] const SiteFile* find(std::string_view target) const;
    [[nodiscard]] std::size_t size() const { return files_.size(); }

private:
    std::map<std::string, SiteFile, std::less<>> files_;  ///< by "/name"
};

}  // namespace taktwerk::hmi::web
