#pragma once
// The CoE object dictionary of a simulated slave: live values addressed by (index, sub). Made once from a
// DeviceDescription: its own objects plus those that follow from it (identity, PDO mappings and assignments, sync manager
// types, synchronisation). After construction nothing is allocated except by set_text(); Entry references stay valid.
// Source: ETG.1000.6 5.6.7, SV33-E manual 7.1.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ecat/description/device_description.hpp"
#include "ecat/wire/sdo_info.hpp"

namespace taktwerk::ecat::sim {

/// What a subindex is for the CoE server; everything but `plain` follows rules of its own when it is written.
enum class EntryRole : std::uint8_t { plain, mapping_count, mapping_entry, assign_count, assign_entry };

class Entry {
public:
    /// Integers as such, BOOL 0 or 1, REAL32 and REAL64 as their bit pattern. STRING: 0.
    [[nodiscard]] std::int64_t get() const noexcept { return value_; }
    /// Takes what fits into the type (the low bits, sign-extended when the type is signed). No range check. Real-time safe.
    void set(std::int64_t value) noexcept;
    [[nodiscard]] const std::string& text() const noexcept { return text_; }
    void set_text(std::string text) { text_ = std::move(text); }

    [[nodiscard]] std::uint16_t index() const noexcept { return index_; }
    [[nodiscard]] std::uint8_t sub() const noexcept { return sub_; }
    [[nodiscard]] DataType type() const noexcept { return type_; }
    [[nodiscard]] std::uint8_t bits() const noexcept { return bits_; }  ///< STRING: 0
    /// Bytes in an SDO; of a STRING its current length.
    [[nodiscard]] std::size_t byte_size() const noexcept { return type_ == DataType::STRING ? text_.size() : (bits_ + 7u) / 8u; }
    [[nodiscard]] bool is_signed() const noexcept { return signed_; }
    [[nodiscard]] Access access() const noexcept { return access_; }
    [[nodiscard]] Mappable mappable() const noexcept { return mappable_; }
    [[nodiscard]] EntryRole role() const noexcept { return role_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::int64_t default_value() const noexcept { return default_; }
    [[nodiscard]] const std::optional<std::int64_t>& minimum() const noexcept { return minimum_; }
    [[nodiscard]] const std::optional<std::int64_t>& maximum() const noexcept { return maximum_; }

private:
    friend class ObjectDictionary;
    std::int64_t value_ = 0, default_ = 0;
    std::optional<std::int64_t> minimum_, maximum_;
    std::string name_, text_, default_text_;
    std::uint16_t index_ = 0;
    std::uint8_t sub_ = 0;
    DataType type_ = DataType::U32;
    std::uint8_t bits_ = 0;
    bool signed_ = false;
    Access access_ = Access::rw;
    Mappable mappable_ = Mappable::no;
    EntryRole role_ = EntryRole::plain;
};

/// What an object as a whole is: ETG.1000.6 5.6.7.1.
struct ObjectShape {
    ObjectCode code = ObjectCode::variable;
    std::uint16_t data_type = 0;  ///< of a record: its CoE type number; 0: the type of its entries
};

class ObjectDictionary {
public:
    explicit ObjectDictionary(const DeviceDescription& description);
    ObjectDictionary(const ObjectDictionary&) = delete;
    ObjectDictionary& operator=(const ObjectDictionary&) = delete;

    /// nullptr when there is no such subindex. Binary search: resolve once, outside the cycle.
    [[nodiscard]] Entry* find(std::uint16_t index, std::uint8_t sub) noexcept;
    [[nodiscard]] const Entry* find(std::uint16_t index, std::uint8_t sub) const noexcept;
    [[nodiscard]] bool has_object(std::uint16_t index) const noexcept;
    /// All entries of an object, ascending; empty when there is no such object.
    [[nodiscard]] std::span<const Entry> object(std::uint16_t index) const noexcept;
    [[nodiscard]] ObjectShape shape(std::uint16_t index) const noexcept;
    /// Its own name where the standard gives one, else what the names of its entries begin with.
    [[nodiscard]] std::string_view object_name(std::uint16_t index) const noexcept;
    /// Value, or `otherwise` when there is no such subindex.
    [[nodiscard]] std::int64_t value(std::uint16_t index, std::uint8_t sub, std::int64_t otherwise = 0) const noexcept;

    /// Every value as the description gives it (power-on of a device without non-volatile memory).
    void reset();
    [[nodiscard]] const std::vector<Entry>& entries() const noexcept { return entries_; }

private:
    void add(const ObjectEntry& object, EntryRole role = EntryRole::plain);
    void add_derived(const DeviceDescription& description);
    void add_pdos(const std::vector<PdoDescription>& pdos, const PdoRules& rules);
    void add_assignment(std::uint16_t index, const std::vector<std::uint16_t>& assigned, const PdoRules& rules);
    void add_synchronisation(std::uint16_t index, const DcDescription& dc);
    /// Objects whose description names sub-indices only have their number of entries in sub-index 0 all the same.
    void add_counts();

    std::vector<Entry> entries_;  // ascending by (index, sub)
};

}  // namespace taktwerk::ecat::sim
