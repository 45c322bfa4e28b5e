// The committed seeds of every fuzz target, and what some changed bytes make of them, in the ordinary build: a target that no longer
// builds or that breaks on a known input is seen by `./dev test`, not by the next night. A breach ends the process; the last line that
// was printed names the seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/property_cases.hpp"

#define TAKTWERK_FUZZ_TARGET(name) extern "C" int name(const std::uint8_t*, std::size_t);
#include "tests/fuzz/targets.inc"
#undef TAKTWERK_FUZZ_TARGET

namespace taktwerk::fuzz {
namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

const fs::path& folder() {
    static const fs::path path = fs::path(TAKTWERK_SOURCE_DIR) / "tests" / "fuzz";
    return path;
}

using Target = int (*)(const std::uint8_t*, std::size_t);
const std::map<std::string, Target>& targets() {
    static const std::map<std::string, Target> all{
#define TAKTWERK_FUZZ_TARGET(name) {#name, name},
#include "tests/fuzz/targets.inc"
#undef TAKTWERK_FUZZ_TARGET
    };
    return all;
}

struct Seed {
    std::string target, file;
};
std::vector<Seed> seeds() {
    std::vector<Seed> found;
    for (const auto& [target, run] : targets())
        if (fs::is_directory(folder() / "corpus" / target))
            for (const auto& entry : fs::directory_iterator(folder() / "corpus" / target))
                found.push_back({target, entry.path().filename().string()});
    std::sort(found.begin(), found.end(),
              [](const Seed& a, const Seed& b) { return std::tie(a.target, a.file) < std::tie(b.target, b.file); });
    return found;
}

Input read(const Seed& seed) {
    std::ifstream file(folder() / "corpus" / seed.target / seed.file, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// One to four changes of the kinds that find most: a bit, a telling byte, a piece gone, a piece twice.
Input changed(Input bytes, std::mt19937& random) {
    const auto pick = [&](std::size_t n) { return n == 0 ? std::size_t{0} : std::size_t{random()} % n; };
    for (auto changes = 1 + pick(4); changes > 0 && !bytes.empty(); --changes) {
        const auto at = static_cast<std::ptrdiff_t>(pick(bytes.size()));
        const auto length = static_cast<std::ptrdiff_t>(pick(std::min<std::size_t>(bytes.size() - static_cast<std::size_t>(at), 16)) + 1);
        constexpr std::uint8_t telling[] = {0, 1, 0x7F, 0x80, 0xFF, '\n', '-', '`', '"', '0', '9', 'e', ':', ' '};
        switch (random() % 4) {
            case 0: bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1u << random() % 8); break;
            case 1: bytes[static_cast<std::size_t>(at)] = telling[pick(std::size(telling))]; break;
            case 2: bytes.erase(bytes.begin() + at, bytes.begin() + at + length); break;
            default: {
                const Input piece(bytes.begin() + at, bytes.begin() + at + length);
                bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(pick(bytes.size())), piece.begin(), piece.end());
            }
        }
    }
    return bytes;
}

class FuzzSeed : public testing::TestWithParam<Seed> {};

TEST_P(FuzzSeed, AndWhatIsNearItBreakNothing) {
    const auto run = targets().at(GetParam().target);
    const auto seed = read(GetParam());
    EXPECT_EQ(run(seed.data(), seed.size()), 0) << "a seed that its target does not want";
    std::mt19937 random{7};
    for (std::size_t i = 0; i < property_cases(50); ++i) {
        const auto near = changed(seed, random);
        (void)run(near.data(), near.size());
    }
}

std::string name_of(const testing::TestParamInfo<Seed>& seed) {
    auto name = seed.param.target + "_" + seed.param.file;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Seeds, FuzzSeed, testing::ValuesIn(seeds()), name_of);

TEST(FuzzTargets, EachIsInTheListAndHasSeeds) {
    std::size_t sources = 0;
    for (const auto& entry : fs::directory_iterator(folder())) {
        const auto stem = entry.path().stem().string();
        if (!stem.ends_with("_fuzz")) continue;
        ++sources;
        EXPECT_TRUE(targets().contains(stem)) << "add it to targets.inc";
        const auto corpus = folder() / "corpus" / stem;
        EXPECT_TRUE(fs::is_directory(corpus) && !fs::is_empty(corpus)) << stem << " has no seed in tests/fuzz/corpus/";
    }
    EXPECT_EQ(sources, targets().size());
}

}  // namespace
}  // namespace taktwerk::fuzz
