// What the loader says to a file that is no proper program: one clear error each, and never a crash.

#include "runtime/tasks/program_library.hpp"

#include <elf.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "programs/api/abi.hpp"
#include "runtime/tasks/io_image.hpp"
#include "runtime/tasks/program_host.hpp"
#include "runtime/tasks/shared_object_check.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string foreign(const std::string& name) { return TAKTWERK_BINARY_DIR "/programs/foreign/" + name + ".so"; }

class ProgramFile : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = fs::temp_directory_path() / "taktwerk-loader-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string written(const std::string& name, const std::string& bytes) {
        const auto path = folder_ / name;
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }
    static std::string bytes_of(const std::string& path) {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    fs::path folder_;
};

void expect_refused(const std::string& path, std::string_view code, const std::string& words) {
    const auto library = ProgramLibrary::open(path);
    ASSERT_FALSE(library.ok()) << path << " was taken";
    EXPECT_EQ(library.error().code, code);
    EXPECT_THAT(library.error().text(), HasSubstr(words));
    EXPECT_THAT(library.error().subject, HasSubstr(fs::path(path).filename().string()));
    EXPECT_FALSE(library.error().remedy.empty());
}

TEST_F(ProgramFile, GoodOneIsLoadedAndCreated) {
    const auto library = ProgramLibrary::open(foreign("good"));
    ASSERT_TRUE(library.ok()) << library.error().text();
    EXPECT_STREQ(library->entry().name, "Good");
    EXPECT_STREQ(library->entry().sdk_version, sdk_version);

    const auto program = library->create();
    ASSERT_TRUE(program.ok());
    EXPECT_NE(*program, nullptr);
}

TEST_F(ProgramFile, ThatIsMissingIsSaidToBeMissing) {
    expect_refused((folder_ / "nowhere.so").string(), "program.missing", "no such file");
    EXPECT_EQ(ProgramLibrary::open("").error().code, "program.missing");
}

TEST_F(ProgramFile, ThatIsAFolderIsNoFile) { expect_refused(folder_.string(), "program.missing", "not a file"); }

TEST_F(ProgramFile, OfTextIsNoSharedObject) {
    expect_refused(written("notes.txt", "This is text, and long enough to hold a header if it were one: " + std::string(200, '.')),
                   "program.not_loadable", "no shared object");
    expect_refused(written("empty.so", ""), "program.not_loadable", "no shared object");
}

TEST_F(ProgramFile, CutShortIsRefusedBeforeItIsMapped) {
    const auto whole = bytes_of(foreign("good"));
    ASSERT_GT(whole.size(), 4096u);
    // ELF-64: 64 bytes of header, then 56 a program header. The last loadable segment is lost in each of these.
    for (const std::size_t size : {std::size_t{64}, std::size_t{100}, std::size_t{4096}})
        expect_refused(written("short.so", whole.substr(0, size)), "program.not_loadable", "cut short");
}

TEST_F(ProgramFile, WithHostileLengthsIsRefused) {
    auto bytes = bytes_of(foreign("good"));
    Elf64_Ehdr header{};
    bytes.copy(reinterpret_cast<char*>(&header), sizeof header);
    header.e_phoff = ~std::uint64_t{0} - 8;
    bytes.replace(0, sizeof header, reinterpret_cast<const char*>(&header), sizeof header);
    expect_refused(written("far.so", bytes), "program.not_loadable", "cut short");
}

TEST_F(ProgramFile, ForAnotherProcessorSaysSo) {
    auto bytes = bytes_of(foreign("good"));
    bytes[offsetof(Elf64_Ehdr, e_machine)] = static_cast<char>(EM_386);
    bytes[offsetof(Elf64_Ehdr, e_machine) + 1] = 0;
    expect_refused(written("other.so", bytes), "program.not_loadable", "another processor");
}

TEST_F(ProgramFile, ThatIsAnObjectFileIsNoSharedObject) {
    auto bytes = bytes_of(foreign("good"));
    bytes[offsetof(Elf64_Ehdr, e_type)] = ET_REL;
    expect_refused(written("object.so", bytes), "program.not_loadable", "no shared object but");
}

TEST_F(ProgramFile, WithoutTheEntryNamesTheMacro) { expect_refused(foreign("no_entry"), "program.no_entry", "TAKTWERK_PROGRAM"); }

TEST_F(ProgramFile, WithAnUnresolvedSymbolNamesIt) { expect_refused(foreign("unresolved"), "program.not_loadable", "taktwerk_nowhere"); }

TEST_F(ProgramFile, OfAnotherSdkNamesBothVersions) {
    expect_refused(foreign("wrong_abi"), "program.abi", "SDK 0.0.7");
    expect_refused(foreign("wrong_abi"), "program.abi", std::string("this runtime is ") + sdk_version);
    expect_refused(foreign("wrong_abi"), "program.abi", "rebuild");
}

TEST_F(ProgramFile, WithAForeignEntryIsRefused) {
    expect_refused(foreign("wrong_magic"), "program.foreign", "not one of a Taktwerk program");
    expect_refused(foreign("incomplete_entry"), "program.foreign", "incomplete");
}

TEST_F(ProgramFile, WhoseConstructorThrowsTellsWhatItThrew) {
    const auto library = ProgramLibrary::open(foreign("throwing_constructor"));
    ASSERT_TRUE(library.ok());
    const auto program = library->create();
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().code, "program.constructor");
    EXPECT_THAT(program.error().text(), HasSubstr("recipe.txt: no such file"));
}

// The machine's view: every program of the file is tried, and each has exactly one error that names it.
TEST_F(ProgramFile, EachBadOneOfAMachineIsOneErrorThatNamesTheProgram) {
    MachineConfig config;
    for (const char* name : {"throwing_constructor", "throwing_declare", "wrong_abi", "good"}) {
        ProgramConfig program;
        program.name = name;
        program.library = foreign(name);
        config.programs.push_back(program);
    }
    std::vector<Error> errors;
    const IoImage io{{}, {}};

    axes::MotionTables tables;
    const ProgramHost host{config, io, tables, errors};

    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0].code, "program.constructor");
    EXPECT_EQ(errors[1].code, "program.declare");
    EXPECT_EQ(errors[2].code, "program.abi");
    for (std::size_t i = 0; i < 3; ++i) EXPECT_THAT(errors[i].text(), HasSubstr(config.programs[i].name));
    EXPECT_EQ(host.tasks().size(), 1u) << "the good one's";
}

/// A header, one PT_NOTE of this alignment, and its notes: 20h bytes of a property first, as gcc and mold lay them out.
std::string with_notes(std::uint64_t alignment) {
    Elf64_Ehdr header{};
    header.e_phoff = sizeof header;
    header.e_phentsize = sizeof(Elf64_Phdr);
    header.e_phnum = 1;
    std::string notes;
    const auto add = [&notes](std::uint32_t type, const std::string& description) {
        const Elf64_Nhdr note{4, static_cast<std::uint32_t>(description.size()), type};
        notes.append(reinterpret_cast<const char*>(&note), sizeof note).append("GNU", 4).append(description);
    };
    add(NT_GNU_PROPERTY_TYPE_0, std::string(16, 'p'));
    add(NT_GNU_ABI_TAG, std::string(16, 'a'));
    add(NT_GNU_BUILD_ID, std::string("\x01\xab", 2) + std::string(18, '\0'));
    Elf64_Phdr segment{};
    segment.p_type = PT_NOTE;
    segment.p_offset = sizeof header + sizeof segment;
    segment.p_filesz = notes.size();
    segment.p_align = alignment;
    return std::string(reinterpret_cast<const char*>(&header), sizeof header)
        .append(reinterpret_cast<const char*>(&segment), sizeof segment)
        .append(notes);
}

TEST_F(ProgramFile, ItsBuildIdIsFoundHoweverTheLinkerAlignsItsNotes) {
    for (const std::uint64_t alignment : {4u, 8u})
        EXPECT_EQ(build_id_of(written("notes", with_notes(alignment))), "01ab" + std::string(36, '0')) << alignment;
    EXPECT_EQ(build_id_of("/proc/self/exe").size(), 40u) << "of what this tree's linker makes: SHA-1";
}

}  // namespace
}  // namespace taktwerk::runtime
