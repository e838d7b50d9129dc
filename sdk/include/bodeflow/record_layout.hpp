#pragma once

#include <bodeflow/abi.h>

#include <complex>
#include <cstddef>
#include <cstdint>

/// The bytes of a record.
///
/// A record is one contiguous little-endian block that begins at a 64-byte boundary; its size is a multiple of 64. Offsets
/// count bytes from its start. Everything that is not named here (gaps, padding) is zero, so equal content gives equal bytes.
///
///   header          64 bytes  RecordHeader
///   attribute table           RecordAttribute[attribute_count], at an offset that is a multiple of 8
///   array table               RecordArray[array_count], at an offset that is a multiple of 8
///   values                    of attributes: int64 or double each 8 bytes, bool as int64 0 or 1, text as a RecordText
///   texts                     UTF-8 without NUL inside, followed by one NUL that the length does not count
///   data                      of arrays, row-major, each at an offset that is a multiple of 64
///
/// Names, units and the type name have at most 255 bytes; the names of attributes are unique, so are those of arrays.
/// No two parts share bytes: the sum of all parts is at most the record's size.
namespace bodeflow {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are little-endian");

inline constexpr char kRecordMagic[4] = {'B', 'F', 'R', '1'};
inline constexpr std::uint32_t kRecordVersion = 1;
inline constexpr std::uint64_t kRecordAlignment = 64;
inline constexpr std::uint32_t kRecordMaxRank = 8;
inline constexpr std::uint32_t kRecordMaxName = 255;

/// A text by place and length.
struct RecordText {
  std::uint64_t offset;
  std::uint32_t length;    ///< bytes without the NUL
  std::uint32_t reserved;  ///< zero
};

struct RecordHeader {
  char magic[4];  ///< "BFR1"
  std::uint32_t version;
  std::uint64_t size;  ///< of the whole record
  std::uint32_t attribute_count;
  std::uint32_t array_count;
  std::uint64_t attributes;  ///< offset of the attribute table
  std::uint64_t arrays;      ///< offset of the array table
  RecordText type;           ///< "frequency_response"
  std::uint64_t reserved;    ///< zero
};

/// What an attribute holds, one or a list of it.
enum class AttributeKind : std::uint32_t { boolean = 1, integer = 2, number = 3, text = 4 };

struct RecordAttribute {
  RecordText name;
  std::uint32_t kind;    ///< AttributeKind
  std::uint32_t list;    ///< 1: a list, 0: a single value, then count = 1
  std::uint64_t count;   ///< values
  std::uint64_t values;  ///< offset, a multiple of 8
  std::uint64_t reserved;
};

struct RecordArray {
  RecordText name;
  RecordText unit;
  std::uint32_t element;                ///< BF_F64, BF_C64, BF_I64, BF_U8
  std::uint32_t rank;                   ///< 0 (one value) .. 8
  std::uint64_t data;                   ///< offset, a multiple of 64
  std::uint64_t bytes;                  ///< product of the shape times the element's size
  std::uint64_t shape[kRecordMaxRank];  ///< zero beyond the rank
  std::uint64_t reserved;
};

static_assert(sizeof(RecordText) == 16 && sizeof(RecordHeader) == 64);
static_assert(sizeof(RecordAttribute) == 48 && sizeof(RecordArray) == 128);

/// Bytes of one element of a BF_F64 ... BF_U8 type; 0 for anything else.
constexpr std::uint64_t element_size(std::uint32_t element) {
  switch (element) {
    case BF_F64:
    case BF_I64:
      return 8;
    case BF_C64:
      return 16;
    case BF_U8:
      return 1;
    default:
      return 0;
  }
}

/// The name of an element type in messages: "f64", "c64", "i64", "u8", "any".
constexpr const char* element_name(std::uint32_t element) {
  switch (element) {
    case BF_F64:
      return "f64";
    case BF_C64:
      return "c64";
    case BF_I64:
      return "i64";
    case BF_U8:
      return "u8";
    case BF_ANY:
      return "any";
    default:
      return "unknown";
  }
}

/// The BF_* constant of a C++ type; BF_ANY for a type that no array or stream carries.
template <class T>
inline constexpr std::uint32_t kElementOf = BF_ANY;
template <>
inline constexpr std::uint32_t kElementOf<double> = BF_F64;
template <>
inline constexpr std::uint32_t kElementOf<std::complex<double>> = BF_C64;
template <>
inline constexpr std::uint32_t kElementOf<std::int64_t> = BF_I64;
template <>
inline constexpr std::uint32_t kElementOf<std::uint8_t> = BF_U8;

/// `offset` rounded up to a multiple of `alignment`.
constexpr std::uint64_t align_up(std::uint64_t offset, std::uint64_t alignment) {
  return (offset + alignment - 1) / alignment * alignment;
}

}  // namespace bodeflow
