#include "tests/architecture/one_name.hpp"

#include <map>
#include <regex>
#include <sstream>
#include <string>

namespace taktwerk::architecture {

Violations check_names_stand_once(const std::vector<SourceFile>& files) {
    static const std::regex opens(R"(^(?:inline )?namespace ?([\w:]*) ?\{)");
    static const std::regex closes(R"(^\}\s*// namespace.*)");
    static const std::regex named(R"(^(?:struct|class|enum class|enum) (\w+)(?: final)?(?: : [^;]*)? \{.*)");
    std::map<std::string, std::string> seen;
    Violations violations;
    for (const auto& file : files) {
        std::vector<std::string> inside;
        std::istringstream text(file.text);
        std::size_t number = 0;
        for (std::string line; std::getline(text, line);) {
            ++number;
            if (line.empty() || line[0] == ' ' || line[0] == '#') continue;
            std::smatch match;
            if (std::regex_search(line, match, opens)) {
                inside.push_back(match[1]);
            } else if (std::regex_match(line, closes)) {
                if (!inside.empty()) inside.pop_back();
            } else if (std::regex_match(line, match, named)) {
                std::string name;
                bool own = false;
                for (const auto& each : inside) own = own || each.empty(), name += each + "::";
                if (own) continue;
                const auto place = file.path + ":" + std::to_string(number);
                const auto [first, fresh] = seen.emplace(name + match[1].str(), place);
                if (!fresh)
                    violations.push_back(first->first + " stands in " + first->second + " and in " + place +
                                         ": rename one, or give it a namespace");
            }
        }
    }
    return violations;
}

}  // namespace taktwerk::architecture
