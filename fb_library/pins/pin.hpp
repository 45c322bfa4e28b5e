#pragma once
// Pins of function blocks as data. A block writes its table once, from member pointers:
//
//     template <class Self>
//     static consteval auto pins() { return std::array{in<&Self::PT>("", "delay time"), out<&Self::Q>("", "delayed IN")}; }
//
// Name, type, size and offset come from the member, so a name stands once. Everything here is a constant: no run time, no
// allocation. (`pins()` is a function because the class is complete only inside function bodies; offsets need that. It is a template so
// that whoever calls a block does not pay the compiler for its table: whoever wants it says `pins_of<Block>`. A plain function will do.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::fb {

/// IEC 61131-3 ed. 3 elementary types (6.4.2), plus handles and enumerations.
enum class PinKind : std::uint8_t {
    BOOL,
    SINT,
    INT,
    DINT,
    LINT,
    USINT,
    UINT,
    UDINT,
    ULINT,
    REAL,
    LREAL,
    WORD,
    DWORD,
    TIME,        ///< int64 nanoseconds: never wraps in the life of a machine (292 years)
    AXIS_REF,    ///< axes::AxisRef, a handle
    DEVICE_REF,  ///< taktwerk::DeviceRef, a handle
    HANDLE,      ///< to something else; PinType::name says to what ("MC_CAM_REF"). Its bytes mean nothing outside the machine
    ENUM,        ///< unsigned 8 bit; PinType::values names the numbers 0, 1, ...
    STRUCT,      ///< several values, by members; PinType::name says which ("MC_POS_REF"). Monitors and retained values pass it by
};

/// 32 bits that are no number (DWORD).
struct DWORD {
    std::uint32_t bits = 0;
    constexpr DWORD() noexcept = default;
    constexpr DWORD(std::uint32_t value) noexcept : bits(value) {}      // NOLINT(google-explicit-constructor): a literal may be
    constexpr operator std::uint32_t() const noexcept { return bits; }  // NOLINT(google-explicit-constructor): assigned to one
};

struct PinType {
    PinKind kind = PinKind::BOOL;
    std::string_view name;                          ///< as the standard spells it: "LREAL", "MC_BUFFER_MODE"
    std::span<const std::string_view> values = {};  ///< ENUM only
};

enum class PinDirection : std::uint8_t { in, out, in_out };

struct Pin {
    std::string_view name;
    PinDirection direction = PinDirection::in;
    PinType type;
    std::size_t offset = 0, size = 0;  ///< bytes, within the block
    std::string_view unit;             ///< "" = none; u = the axis' configured unit
    std::string_view doc;
};

/// Specialised for each C++ type that may be a pin: `static constexpr PinType value`.
template <class T>
struct PinTypeOf;

// clang-format off
template <> struct PinTypeOf<bool> { static constexpr PinType value{PinKind::BOOL, "BOOL"}; };
template <> struct PinTypeOf<std::int8_t> { static constexpr PinType value{PinKind::SINT, "SINT"}; };
template <> struct PinTypeOf<std::int16_t> { static constexpr PinType value{PinKind::INT, "INT"}; };
template <> struct PinTypeOf<std::int32_t> { static constexpr PinType value{PinKind::DINT, "DINT"}; };
template <> struct PinTypeOf<std::int64_t> { static constexpr PinType value{PinKind::LINT, "LINT"}; };
template <> struct PinTypeOf<std::uint8_t> { static constexpr PinType value{PinKind::USINT, "USINT"}; };
template <> struct PinTypeOf<std::uint16_t> { static constexpr PinType value{PinKind::UINT, "UINT"}; };
template <> struct PinTypeOf<std::uint32_t> { static constexpr PinType value{PinKind::UDINT, "UDINT"}; };
template <> struct PinTypeOf<std::uint64_t> { static constexpr PinType value{PinKind::ULINT, "ULINT"}; };
template <> struct PinTypeOf<float> { static constexpr PinType value{PinKind::REAL, "REAL"}; };
template <> struct PinTypeOf<double> { static constexpr PinType value{PinKind::LREAL, "LREAL"}; };
template <> struct PinTypeOf<DWORD> { static constexpr PinType value{PinKind::DWORD, "DWORD"}; };
template <> struct PinTypeOf<Duration> { static constexpr PinType value{PinKind::TIME, "TIME"}; };
// clang-format on

namespace detail {

template <class Pointer>
struct MemberOf;
template <class C, class T>
struct MemberOf<T C::*> {
    using Class = C;
    using Type = T;
};

/// The last name in what the compiler calls a function with a member for its argument: "... [with auto M = &ns::Block::Execute]" (g++),
/// "... [M = &ns::Block::Execute]" (clang++). From the end and no template, since there are some two thousand pins.
consteval std::string_view last_name(const char* signature, std::size_t size) {
    std::size_t end = size;
    while (end > 0 && (signature[end - 1] == ']' || signature[end - 1] == ')')) --end;
    std::size_t begin = end;
    while (begin > 0 && signature[begin - 1] != ':' && signature[begin - 1] != ' ') --begin;
    if (begin < 2 || signature[begin - 1] != ':' || end == size) throw "unknown compiler spelling";
    return {signature + begin, end - begin};
}
template <auto M>
consteval auto member_name() {  // a type spelled out here would be explained in what is read
    return last_name(__PRETTY_FUNCTION__, sizeof __PRETTY_FUNCTION__ - 1);
}

/// The name of T without namespaces and template arguments.
template <class T>
consteval std::string_view type_name() {
    constexpr std::string_view text = __PRETTY_FUNCTION__;
    constexpr auto begin = text.find("T = ") + 4;
    constexpr auto end = text.find_first_of(";]<", begin);
    constexpr auto whole = text.substr(begin, end - begin);
    constexpr auto colons = whole.rfind("::");
    return colons == std::string_view::npos ? whole : whole.substr(colons + 2);
}

/// An array of T beginning `Shift` bytes into an object.
template <class T, std::size_t N, std::size_t Shift>
struct ShiftedSlots {
    std::byte before[Shift];
    T slots[N];
};
template <class T, std::size_t N>
struct ShiftedSlots<T, N, 0> {
    T slots[N];
};

template <class C, class T, std::size_t Shift>
union Overlay {
    C object;
    ShiftedSlots<T, sizeof(C) / sizeof(T) + 1, Shift> laid;
    constexpr Overlay() : object{} {}
};
template <class C, class T, std::size_t Shift>
inline constexpr Overlay<C, T, Shift> overlay{};

/// offsetof for a member pointer, as a constant: the member is looked for among the slots of an array laid over the object.
template <std::size_t Shift = 0, class C, class T>
consteval std::size_t offset_of(T C::*member) {
    constexpr auto& laid = overlay<C, T, Shift>;
    for (std::size_t i = 0; i <= sizeof(C) / sizeof(T); ++i)
        if (&laid.laid.slots[i] == &(laid.object.*member)) return Shift + i * sizeof(T);
    // A handle of 6 bytes lies at a multiple of its alignment, not of 6.
    if constexpr (Shift + alignof(T) < sizeof(T)) return offset_of<Shift + alignof(T)>(member);
    else throw "a pin lies nowhere";  // not a constant: the build stops here
}

template <auto M>
consteval Pin pin(PinDirection direction, std::string_view unit, std::string_view doc) {
    using T = typename MemberOf<decltype(M)>::Type;
    return {member_name<M>(), direction, PinTypeOf<T>::value, offset_of(M), sizeof(T), unit, doc};
}

}  // namespace detail

template <auto Member>
consteval Pin in(std::string_view unit, std::string_view doc) {
    return detail::pin<Member>(PinDirection::in, unit, doc);
}
template <auto Member>
consteval Pin out(std::string_view unit, std::string_view doc) {
    return detail::pin<Member>(PinDirection::out, unit, doc);
}
template <auto Member>
consteval Pin in_out(std::string_view unit, std::string_view doc) {
    return detail::pin<Member>(PinDirection::in_out, unit, doc);
}

namespace detail {
template <class T>
inline constexpr std::size_t pins_in = 1;
template <std::size_t N>
inline constexpr std::size_t pins_in<std::array<Pin, N>> = N;
}  // namespace detail

/// A table from pins and from runs of pins (`std::array<Pin, N>`), in the order written.
template <class... Pieces>
consteval auto pin_table(const Pieces&... pieces) {
    std::array<Pin, (detail::pins_in<Pieces> + ...)> table{};
    std::size_t next = 0;
    const auto append = [&](const auto& piece) {
        if constexpr (requires { piece.size(); })
            for (const Pin& pin : piece) table[next++] = pin;
        else table[next++] = piece;
    };
    (append(pieces), ...);
    return table;
}

namespace detail {
template <class Block>
consteval auto table_of() requires requires {
    Block::template pins<Block>();
}
{ return Block::template pins<Block>(); }
template <class Block>
consteval auto table_of() requires requires {
    Block::pins();
}
{ return Block::pins(); }
}  // namespace detail

template <class T>
concept HasPins = requires {
    detail::table_of<T>();
};

/// The table of a block.
template <class Block>
inline constexpr auto pins_of = detail::table_of<Block>();

/// A block's name is its type's name, unless it says otherwise (`static constexpr std::string_view block_name`).
template <class Block>
consteval std::string_view block_name() {
    if constexpr (requires { Block::block_name; }) return Block::block_name;
    else return detail::type_name<Block>();
}

}  // namespace taktwerk::fb
