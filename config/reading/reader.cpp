#include "config/reading/reader.hpp"

#include <algorithm>

namespace taktwerk::config {

void Reader::problem(Position at, std::string code, std::string what, std::string remedy) {
    errors_.push_back({std::move(code), located(file_, at), std::move(what), std::move(remedy)});
    bad_paths_.push_back(path_);
}

void Reader::problem_in(std::string_view path, std::string code, std::string what, std::string remedy) {
    errors_.push_back({std::move(code), located(file_, find(path)), std::move(what), std::move(remedy)});
    bad_paths_.emplace_back(path);
}

bool Reader::already_bad(std::string_view path) const {
    const auto inside = [](std::string_view a, std::string_view b) {  // a is b or lies in it
        return a.substr(0, b.size()) == b && (a.size() == b.size() || a[b.size()] == '.');
    };
    return std::any_of(bad_paths_.begin(), bad_paths_.end(),
                       [&](const auto& bad) { return !bad.empty() && (inside(bad, path) || inside(path, bad)); });
}

Position Reader::find(std::string_view path) const {
    for (;;) {
        if (const auto found = positions_.find(path); found != positions_.end()) return found->second;
        const auto dot = path.find_last_of('.');
        if (dot == std::string_view::npos) return {};
        path = path.substr(0, dot);
    }
}

const std::string* Reader::outer_section_with(std::string_view key) const {
    for (auto section = sections_.rbegin(); section != sections_.rend(); ++section)
        if (section->path != path_ && std::find(section->keys->begin(), section->keys->end(), key) != section->keys->end())
            return &section->path;
    return nullptr;
}

Reader::Scope::Scope(Reader& reader, std::string_view key, Position at) : reader_(reader), length_(reader.path_.size()) {
    if (!reader_.path_.empty()) reader_.path_ += '.';
    reader_.path_ += key;
    reader_.positions_.emplace(reader_.path_, at);
}

}  // namespace taktwerk::config
