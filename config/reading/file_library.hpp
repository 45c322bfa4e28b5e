#pragma once
// Finds files by name in some folders; each is read once.

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::config {

/// NAME.yaml in the first folder that has it; empty: nowhere.
[[nodiscard]] std::string find_file(const std::vector<std::string>& folders, const std::string& name);
/// The names of all of them, sorted. What has a second dot (`sv33-e.alarms.yaml`) belongs to another file.
[[nodiscard]] std::vector<std::string> file_names(const std::vector<std::string>& folders);

template <class Loaded>
class FileLibrary {
public:
    using Answer = std::variant<Loaded, std::vector<Error>>;
    using Load = std::function<Answer(const std::string& path)>;
    FileLibrary(std::vector<std::string> folders, Load load) : folders_(std::move(folders)), load_(std::move(load)) {}

    /// nullptr when there is no such file or it has errors (then errors() grew).
    const Loaded* find(const std::string& name) {
        auto found = files_.find(name);
        if (found == files_.end()) {
            const auto path = find_file(folders_, name);
            if (path.empty()) return nullptr;
            found = files_.emplace(name, load_(path)).first;
            if (const auto* errors = std::get_if<std::vector<Error>>(&found->second))
                errors_.insert(errors_.end(), errors->begin(), errors->end());
        }
        return std::get_if<Loaded>(&found->second);
    }
    [[nodiscard]] bool exists(const std::string& name) const { return !find_file(folders_, name).empty(); }
    [[nodiscard]] std::vector<std::string> names() const { return file_names(folders_); }
    [[nodiscard]] const std::vector<std::string>& folders() const noexcept { return folders_; }
    /// Paths of all that was read for those that were found, without repetition.
    [[nodiscard]] std::vector<std::string> files_read() const {
        std::vector<std::string> out;
        for (const auto& [name, answer] : files_)
            if (const auto* loaded = std::get_if<Loaded>(&answer))
                for (const auto& file : loaded->files)
                    if (std::find(out.begin(), out.end(), file) == out.end()) out.push_back(file);
        return out;
    }
    [[nodiscard]] const std::vector<Error>& errors() const noexcept { return errors_; }

private:
    std::vector<std::string> folders_;
    Load load_;
    std::map<std::string, Answer, std::less<>> files_;
    std::vector<Error> errors_;
};

}  // namespace taktwerk::config
