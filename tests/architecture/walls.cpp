#include "tests/architecture/walls.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <regex>
#include <sstream>
#include <string_view>

namespace taktwerk::architecture {
namespace {

std::string at(const SourceFile& file, std::size_t line) { return file.path + ":" + std::to_string(line) + ": "; }

std::optional<std::size_t> level_of(const std::string& floor) {
    const auto& levels = floor_levels();
    for (std::size_t level = 0; level < levels.size(); ++level)
        if (std::find(levels[level].begin(), levels[level].end(), floor) != levels[level].end()) return level;
    return std::nullopt;
}

bool in_any(std::string_view path, const std::vector<std::string>& folders) {
    return std::any_of(folders.begin(), folders.end(), [&](const auto& folder) { return lies_in(path, folder); });
}

/// What may be included only from some folders. `within` narrows the rule to files below those folders; empty: everywhere.
struct OwnedInclude {
    std::regex include;
    std::vector<std::string> owners;
    std::vector<std::string> within;
    std::string what;
};

const std::vector<OwnedInclude>& owned_includes() {
    const std::vector<std::string> motion_side{"axes", "fb_library", "programs"};
    static const std::vector<OwnedInclude> rules{
        {std::regex("^ecat/"), {"axes/drives/cia402", "axes/drives/encoder", "axes/sim"}, motion_side, "ecat/"},
        {std::regex("^modbus/"), {"axes/drives/xp200", "axes/sim"}, motion_side, "modbus/"},
        {std::regex("^(lcm(/|\\.h)|taktwerk_lcm/)"), {"hmi_bridge", "apps"}, {}, "LCM"},
        {std::regex("^yaml-cpp/"), {"config"}, {}, "yaml-cpp"},
        {std::regex("^pugixml"), {"ecat/esi"}, {}, "pugixml"},
        {std::regex("^modbus/modbus"), {"modbus/tcp", "tests"}, {}, "libmodbus"},
        {std::regex("^zstd"), {"runtime/compression"}, {}, "zstd"},
        {std::regex("^(boost/|hmi_bridge/web/server/(?!web_server))"), {"hmi_bridge/web/server"}, {}, "Boost"},
        {std::regex("^sodium(/|\\.h)"), {"hmi_bridge/web/account", "runtime/signature"}, {}, "libsodium"},
        {std::regex("^nlohmann/"), {"hmi_bridge", "apps", "runtime/json", "runtime/scope_file", "runtime/bundle"}, {}, "nlohmann-json"},
        {std::regex("^Eigen/"), {"axes", "tests"}, {}, "Eigen"},
        {std::regex("^sqlite3"), {"hmi_bridge/history"}, {}, "SQLite"},
        {std::regex("^CLI/"), {"apps"}, {}, "CLI11"},
        {std::regex("^(gtest|gmock|benchmark)/"), {"tests"}, {}, "a test library"},
    };
    return rules;
}

/// All folders that `folder` links, directly or through others; without itself unless it links itself through others.
std::set<std::string> reachable(const FolderGraph& graph, const std::string& folder) {
    std::set<std::string> seen;
    std::vector<std::string> open{folder};
    while (!open.empty()) {
        const auto found = graph.find(open.back());
        open.pop_back();
        if (found == graph.end()) continue;
        for (const auto& next : found->second)
            if (seen.insert(next).second) open.push_back(next);
    }
    return seen;
}

/// Judges the includes of one folder's files against what the folder links.
class FolderLinks {
public:
    FolderLinks(const std::vector<SourceFile>& files, const FolderGraph& graph) : graph_(graph) {
        for (const auto& file : files)
            for (const auto& include : include_lines(file.text))
                if (include.quoted) includes_[file.path].push_back(include.path);
    }

    /// The first folder that keeps a file of `folder` from including `header`; nothing when it may.
    std::optional<std::string> obstacle(const std::string& folder, const std::string& header) const {
        std::set<std::string> visited;
        auto allowed = reachable(graph_, folder);
        allowed.insert(folder);
        return obstacle(folder, allowed, header, visited);
    }

private:
    std::optional<std::string> obstacle(const std::string& folder, const std::set<std::string>& allowed, const std::string& header,
                                        std::set<std::string>& visited) const {
        const auto target = folder_of(header);
        if (!level_of(floor_of(header)) || allowed.count(target) != 0 || !visited.insert(header).second) return std::nullopt;
        const bool vocabulary = graph_.count(target) == 0 || lies_in(folder, target);
        if (!vocabulary) return target;
        const auto found = includes_.find(header);
        if (found == includes_.end()) return std::nullopt;
        for (const auto& next : found->second)
            if (auto stop = obstacle(folder, allowed, next, visited)) return *stop + " (through " + header + ")";
        return std::nullopt;
    }

    const FolderGraph& graph_;
    std::map<std::string, std::vector<std::string>> includes_;
};

}  // namespace

const std::vector<std::vector<std::string>>& floor_levels() {
    static const std::vector<std::vector<std::string>> levels{
        {"core"}, {"ecat", "modbus"}, {"axes"}, {"fb_library"}, {"programs"}, {"runtime"}, {"hmi_bridge"}, {"config"}, {"apps"},
    };
    return levels;
}

FolderGraph parse_folder_graph(std::string_view lines) {
    FolderGraph graph;
    std::istringstream all{std::string(lines)};
    for (std::string line; std::getline(all, line);) {
        std::istringstream words(line);
        std::string folder, dependency;
        if (!(words >> folder)) continue;
        auto& dependencies = graph[folder];
        while (words >> dependency)
            if (level_of(floor_of(dependency))) dependencies.insert(dependency);
    }
    return graph;
}

Violations check_floor_order(const std::vector<SourceFile>& files) {
    Violations violations;
    for (const auto& file : files) {
        const auto floor = floor_of(file.path);
        const auto own = level_of(floor);
        if (!own) continue;
        for (const auto& include : include_lines(file.text)) {
            const auto other = floor_of(include.path);
            const auto level = level_of(other);
            if (include.quoted && (include.path.find('/') == std::string::npos || include.path.front() == '.'))
                violations.push_back(at(file, include.line) + "\"" + include.path + "\" is not written from the repository root");
            if (include.quoted && other == "tests") violations.push_back(at(file, include.line) + "includes " + include.path + ", a test");
            if (!level || other == floor) continue;
            if (*level > *own) violations.push_back(at(file, include.line) + "includes " + include.path + ", a higher floor");
            if (*level == *own) violations.push_back(at(file, include.line) + "includes " + include.path + ", a sibling floor");
        }
    }
    return violations;
}

Violations check_owned_includes(const std::vector<SourceFile>& files) {
    Violations violations;
    for (const auto& file : files)
        for (const auto& include : include_lines(file.text))
            for (const auto& rule : owned_includes()) {
                if (!rule.within.empty() && !in_any(file.path, rule.within)) continue;
                if (!std::regex_search(include.path, rule.include) || in_any(file.path, rule.owners)) continue;
                std::string owners;
                for (const auto& owner : rule.owners) owners += (owners.empty() ? "" : ", ") + owner + "/";
                violations.push_back(at(file, include.line) + "includes " + include.path + "; only " + owners + " may include " +
                                     rule.what);
            }
    return violations;
}

Violations check_folder_links(const std::vector<SourceFile>& files, const FolderGraph& graph) {
    Violations violations;
    const FolderLinks links(files, graph);
    for (const auto& file : files) {
        const auto folder = folder_of(file.path);
        if (graph.count(folder) == 0) continue;  // vocabulary is judged at whoever includes it
        for (const auto& include : include_lines(file.text))
            if (const auto stop = include.quoted ? links.obstacle(folder, include.path) : std::nullopt)
                violations.push_back(at(file, include.line) + "includes " + include.path + ", but " + folder + " does not link " + *stop);
    }
    return violations;
}

Violations check_folder_graph(const FolderGraph& graph) {
    Violations violations;
    for (const auto& [folder, dependencies] : graph) {
        const auto own = level_of(floor_of(folder));
        if (!own) violations.push_back(folder + " is on no floor");
        for (const auto& dependency : dependencies) {
            const auto level = level_of(floor_of(dependency));
            if (graph.count(dependency) == 0) violations.push_back(folder + " links " + dependency + ", which is no folder target");
            if (floor_of(dependency) != floor_of(folder) && own && level && *level >= *own)
                violations.push_back(folder + " links " + dependency + ", not a lower floor");
        }
        if (reachable(graph, folder).count(folder) != 0) violations.push_back(folder + " links itself through others");
    }
    return violations;
}

Violations check_determinism(const std::vector<SourceFile>& files) {
    struct Banned {
        std::vector<std::string_view> in_each;  // one of them stands in whatever is banned: most lines are spared the slow search
        std::regex call;
        std::vector<std::string> allowed_in;
        std::string why;
    };
    // core/ owns the clock; the bridge and the commands stamp messages and files for people.
    const std::vector<std::string> stamps{"core", "hmi_bridge", "apps"};
    static const std::array<Banned, 3> banned{{
        {{"clock", "time"},
         std::regex(R"(_clock\s*::\s*now\b|\b(gettimeofday|clock_gettime|timespec_get)\s*\(|\bstd::time\s*\()"),
         stamps,
         "reads a clock; time comes as an argument"},
        {{"rand"}, std::regex(R"(\b(s?rand|drand48)\s*\(|\brandom_device\b)"), {}, "draws random numbers without a seed from outside"},
        {{"sleep"}, std::regex(R"(\bthis_thread\s*::\s*sleep_|\b(u|nano)?sleep\s*\()"), stamps, "sleeps by itself; components step"},
    }};
    const auto may_be = [](const Banned& rule, const std::string& line) {
        return std::any_of(rule.in_each.begin(), rule.in_each.end(), [&](auto part) { return line.find(part) != std::string::npos; });
    };
    Violations violations;
    for (const auto& file : files) {
        std::istringstream code(code_of(file.text, Literals::blank));
        std::string line;
        for (std::size_t number = 1; std::getline(code, line); ++number)
            for (const auto& rule : banned)
                if (!in_any(file.path, rule.allowed_in) && may_be(rule, line) && std::regex_search(line, rule.call))
                    violations.push_back(at(file, number) + rule.why);
    }
    return violations;
}

Violations check_names(const std::vector<SourceFile>& files) {
    static const std::regex nobody(R"((^|[/_])(utils?|helpers?|common|managers?|misc)([/_.]|$))");
    Violations violations;
    for (const auto& file : files)
        if (std::regex_search(file.path, nobody)) violations.push_back(file.path + ": a name that says nothing about whose idea it is");
    return violations;
}

}  // namespace taktwerk::architecture
