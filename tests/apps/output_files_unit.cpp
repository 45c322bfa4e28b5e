// What a command writes is not what it reads.

#include "apps/terminal/output_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct OutputFiles : ::testing::Test {
    OutputFiles() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-output-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::ofstream(folder / "cell.yaml") << "version: 1\n";
    }
    ~OutputFiles() override { fs::remove_all(folder); }
    [[nodiscard]] std::string path(const char* name) const { return (folder / name).string(); }
    [[nodiscard]] std::string refused(const std::string& trace, const std::string& record, const std::string& input) const {
        const std::array outputs{OutputFile{"--trace", trace}, OutputFile{"--record", record}};
        const auto error = output_in_the_way(outputs, std::array{input});
        return error ? error->text() : std::string{};
    }
    fs::path folder;
};

TEST_F(OutputFiles, WhatIsReadIsNotWrittenOverWhateverItIsCalled) {
    fs::create_symlink("cell.yaml", folder / "link");
    for (const auto& name : {path("cell.yaml"), path("./cell.yaml"), path("link")}) {
        EXPECT_THAT(refused(name, "", path("cell.yaml")), HasSubstr("--trace: '" + name + "' would be written over what is to be read"))
            << name;
        EXPECT_THAT(refused("", name, path("cell.yaml")), HasSubstr("--record")) << name;
    }
    EXPECT_EQ(refused(path("a"), path("b"), path("cell.yaml")), "");
    EXPECT_EQ(refused(path("a"), "", ""), "") << "a bundle has no file of its own";
}

TEST_F(OutputFiles, TwoOfThemAreTwoFiles) {
    EXPECT_THAT(refused(path("a"), path("./a"), path("cell.yaml")), HasSubstr("is the file of --trace already"));
    EXPECT_EQ(refused("", "", path("cell.yaml")), "") << "none was asked for";
    EXPECT_EQ(refused("/dev/null", "/dev/null", path("cell.yaml")), "") << "it takes what comes from everybody";
}

}  // namespace
}  // namespace taktwerk::apps
