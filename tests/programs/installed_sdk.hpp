#pragma once
// An installed SDK in a temporary folder, and projects built against it: what a machine builder does.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace taktwerk::testing {

struct Outcome {
    int status = -1;
    std::string output;
};

inline Outcome run(const std::string& command) {
    Outcome outcome;
    // The build below is not this one: its flags must not leak in.
    FILE* pipe = ::popen(("timeout 280 env -u CXXFLAGS -u LDFLAGS -u CPLUS_INCLUDE_PATH -u CPATH " + command + " 2>&1").c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 4096> part{};
    while (const auto n = std::fread(part.data(), 1, part.size(), pipe)) outcome.output.append(part.data(), n);
    outcome.status = ::pclose(pipe);
    return outcome;
}

inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Folder and SDK for a whole suite: installing and building takes seconds. Removed with the object.
class InstalledSdk {
public:
    InstalledSdk() {
        std::string name = std::filesystem::temp_directory_path() / "taktwerk-sdk-XXXXXX";
        if (::mkdtemp(name.data())) folder_ = name;
        std::filesystem::create_directory(project());
        const auto outcome = run(std::string("'" TAKTWERK_CMAKE "' --install '" TAKTWERK_BINARY_DIR "' --component sdk --prefix '") +
                                 prefix().string() + "'");
        EXPECT_EQ(outcome.status, 0) << outcome.output;
    }
    ~InstalledSdk() {
        std::error_code ignored;
        if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
    }
    InstalledSdk(const InstalledSdk&) = delete;
    InstalledSdk& operator=(const InstalledSdk&) = delete;

    /// Configures and builds what lies in project(), with this tree's compiler and generator.
    [[nodiscard]] Outcome build_project() const {
        const auto configured = run(std::string("'" TAKTWERK_CMAKE "' -S '") + project().string() + "' -B '" + build().string() +
                                    "' -G '" TAKTWERK_GENERATOR "' -DCMAKE_CXX_COMPILER='" TAKTWERK_CXX_COMPILER
                                    "' -DCMAKE_BUILD_TYPE=Release"
                                    " -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_PREFIX_PATH='" +
                                    prefix().string() + "'");
        return configured.status == 0 ? run("'" TAKTWERK_CMAKE "' --build '" + build().string() + "'") : configured;
    }
    [[nodiscard]] std::filesystem::path prefix() const { return folder_ / "prefix"; }
    [[nodiscard]] std::filesystem::path project() const { return folder_ / "project"; }
    [[nodiscard]] std::filesystem::path build() const { return project() / "build"; }

private:
    std::filesystem::path folder_;
};

}  // namespace taktwerk::testing
