// Any bytes as a drive's file, as its list of objects or as its list of alarms (the first byte chooses, the other two are small and whole):
// a drive or errors, each with a sentence.
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "config/drive_file/drive_loader.hpp"
#include "tests/fuzz/scratch_folder.hpp"

using namespace taktwerk;

namespace {

constexpr const char* names[] = {"drive.yaml", "drive.objects.yaml", "drive.alarms.yaml"};

std::string whole(const char* name) {
    std::ifstream file(std::string(TAKTWERK_SOURCE_DIR "/tests/fuzz/small_drive/") + name, std::ios::binary);
    if (!file) std::abort();
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::ScratchFolder folder;
    static const std::string small[] = {whole(names[0]), whole(names[1]), whole(names[2])};
    static const bool begun = [] {
        for (std::size_t i = 0; i < 3; ++i) folder.write(names[i], small[i]);
        // The files around the input are a drive, or this target would look at nothing but their errors.
        return std::holds_alternative<config::LoadedDrive>(config::load_drive((folder.path() / names[0]).string()));
    }();
    if (!begun) std::abort();
    if (size == 0) return 0;
    const auto chosen = data[0] % 3u;
    folder.write(names[chosen], {reinterpret_cast<const char*>(data) + 1, size - 1});
    const auto loaded = config::load_drive((folder.path() / names[0]).string());
    folder.write(names[chosen], small[chosen]);
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        if (errors->empty()) std::abort();
        for (const auto& error : *errors)
            if (error.what.empty()) std::abort();
    }
    return 0;
}
