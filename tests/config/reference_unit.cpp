// The committed schemas and the reference page are what the field tables give. TAKTWERK_REGENERATE=1 writes them.

#include "config/reference/reference.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace taktwerk::config {
namespace {

void expect_committed(const std::string& file, const std::string& generated) {
    const std::string path = std::string(TAKTWERK_SOURCE_DIR) + "/" + file;
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) std::ofstream(path) << generated;
    std::ifstream stream(path);
    const std::string committed{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_TRUE(committed == generated) << file << " is not what the field tables give: run tests with TAKTWERK_REGENERATE=1 and commit it";
}

TEST(Reference, TheMachineSchemaIsTheCommittedOne) { expect_committed("config/schema/machine.schema.json", machine_schema()); }
TEST(Reference, TheDriveSchemaIsTheCommittedOne) { expect_committed("config/schema/drive.schema.json", drive_schema()); }
TEST(Reference, TheDeviceSchemaIsTheCommittedOne) { expect_committed("config/schema/device.schema.json", device_schema()); }
TEST(Reference, TheReferencePageIsTheCommittedOne) { expect_committed("docs/configuration.md", reference_page()); }

}  // namespace
}  // namespace taktwerk::config
