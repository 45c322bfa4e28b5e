#include "apps/bundle/packed_machine.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "runtime/bundle/container.hpp"
#include "runtime/bundle/durable.hpp"

namespace taktwerk::apps {

namespace {

namespace fs = std::filesystem;
using Kind = config::UsedFile::Kind;

const char* word(Kind kind) {
    switch (kind) {
        case Kind::drive: return "drive";
        case Kind::device: return "device";
        case Kind::program: return "program";
        case Kind::cam: return "cam";
        case Kind::path: return "path";
        case Kind::image: return "image";
    }
    return "";
}

bool beside_the_machine(Kind kind) { return kind == Kind::program || kind == Kind::cam || kind == Kind::path || kind == Kind::image; }

/// How many folders a relative path goes up before it goes down.
std::size_t steps_up(const std::string& written) {
    std::size_t count = 0;
    for (const auto& part : fs::path(written).lexically_normal()) count += part == ".." ? 1 : 0;
    return count;
}

Result<std::string> bytes_of(const std::string& path) {
    std::error_code failed;
    const auto file = fs::canonical(path, failed);
    if (failed)
        return Error{"bundle.unreadable", path, fmt::format("it cannot be read: {}", failed.message()),
                     "look at the file and its permissions"};
    return runtime::read_small_file(file, runtime::largest_packed_file);
}

}  // namespace

std::string PackedMachine::place_of(const std::string& written) const {
    return (fs::path(machine_file).parent_path() / written).lexically_normal().generic_string();
}

Result<PackedMachine> pack(const std::string& machine_file, const std::vector<config::UsedFile>& used) {
    std::size_t deepest = 1;  // drives/ and devices/ are looked up beside the machine file's folder
    for (const auto& file : used) {
        if (!beside_the_machine(file.kind)) continue;
        if (fs::path(file.written).is_absolute())
            return Error{"bundle.absolute", machine_file,
                         fmt::format("it names '{}', which is a path of this computer alone", file.written),
                         "write it relative to the machine file"};
        deepest = std::max(deepest, steps_up(file.written));
    }
    PackedMachine out;
    for (std::size_t i = 1; i < deepest; ++i) out.machine_file += "above/";
    out.machine_file += "machine/" + fs::path(machine_file).filename().string();

    std::map<std::string, runtime::FileToPack> by_path;
    const auto add = [&](const std::string& place, const char* kind, const std::string& from) -> Result<void> {
        auto bytes = bytes_of(from);
        if (!bytes) return bytes.error();
        const auto [there, is_new] = by_path.try_emplace(place, runtime::FileToPack{place, kind, *bytes});
        if (is_new || there->second.bytes == *bytes) return {};
        return Error{"bundle.collision", from,
                     fmt::format("another file has its place in the bundle already, '{}', and is not the same", place),
                     "give one of the two files another name"};
    };
    if (auto ok = add(out.machine_file, "machine", machine_file); !ok) return ok.error();
    for (const auto& file : used) {
        const auto written = file.kind == Kind::drive    ? "../drives/" + file.written
                             : file.kind == Kind::device ? "../devices/" + file.written
                                                         : file.written;
        if (auto ok = add(out.place_of(written), word(file.kind), file.path); !ok) return ok.error();
    }
    out.files.push_back(std::move(by_path.extract(out.machine_file).mapped()));
    for (auto& [place, file] : by_path) out.files.push_back(std::move(file));
    return out;
}

}  // namespace taktwerk::apps
