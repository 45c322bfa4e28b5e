#pragma once
// Collects what is wrong with a configuration, in the words that recur.

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/nearest_name.hpp"
#include "core/result.hpp"

namespace taktwerk::runtime {

class Problems {
public:
    explicit Problems(std::vector<Error>& errors) : errors_(errors) {}
    void add(std::string code, std::string subject, std::string what, std::string remedy) {
        errors_.push_back({std::move(code), std::move(subject), std::move(what), std::move(remedy)});
    }
    void unknown(std::string code, std::string subject, std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known) {
        const auto near = nearest_name(name, known);
        std::string list;
        for (const auto& n : known) list += (list.empty() ? "" : ", ") + n;
        add(std::move(code), std::move(subject),
            fmt::format("there is no {} '{}' (there is: {})", kind, name, list.empty() ? "none" : list),
            near.empty() ? "correct the name" : fmt::format("did you mean '{}'?", near));
    }
    template <class Names>
    void duplicates(const Names& names, std::string_view what) {
        std::set<std::string> seen;
        for (const auto& n : names) {
            if (n.empty()) add("config.name_missing", std::string(what), "a name is empty", "give it a name");
            else if (!seen.insert(n).second)
                add("config.duplicate_name", fmt::format("{}.{}", what, n), "the name is used twice", "rename one of them");
        }
    }

private:
    std::vector<Error>& errors_;
};

}  // namespace taktwerk::runtime
