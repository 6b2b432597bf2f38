#include "call.hpp"

#include <cstdio>
#include <new>
#include <system_error>

#include <raylanes/version.hpp>

namespace raylanes::c {
namespace {

thread_local char last_message[512] = "";

raylanes_status failed(raylanes_status status, const char* message) noexcept {
  std::snprintf(last_message, sizeof last_message, "%s", message);
  return status;
}

[[noreturn]] void refuse(const char* what, const std::string& why) {
  throw std::invalid_argument(std::string(what) + ": " + why);
}

}  // namespace

raylanes_status status_of_exception() noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return failed(RAYLANES_OUT_OF_MEMORY, "there is not enough memory");
  } catch (const std::length_error& error) {
    return failed(RAYLANES_TOO_LARGE, error.what());
  } catch (const std::logic_error& error) {  // no such part, or a scene without update()
    return failed(RAYLANES_INVALID_ARGUMENT, error.what());
  } catch (const SmallBuffer& buffer) {
    std::snprintf(last_message, sizeof last_message, "the buffer has %zu bytes, %zu are needed",
                  buffer.capacity, buffer.size);
    return RAYLANES_SMALL_BUFFER;
  } catch (const Cancelled&) {
    return failed(RAYLANES_CANCELLED, "a function of the caller ended the call");
  } catch (const std::system_error& error) {  // also a std::runtime_error
    return failed(RAYLANES_FAILED, error.what());
  } catch (const std::runtime_error& error) {
    return failed(RAYLANES_BAD_FILE, error.what());
  } catch (const std::exception& error) {
    return failed(RAYLANES_FAILED, error.what());
  } catch (...) {
    return failed(RAYLANES_FAILED, "something that is no std::exception was thrown");
  }
}

void require_pointer(const char* what, const void* pointer) {
  if (pointer == nullptr) refuse(what, "it is NULL");
}

std::size_t checked_stride(const char* what, const void* first, std::size_t count, std::size_t stride,
                           std::size_t size) {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max());
  if (stride == 0) stride = size;
  if (stride < size)
    refuse(what,
           "a stride of " + std::to_string(stride) + " bytes, the elements have " + std::to_string(size));
  if (count == 0) return stride;
  if (first == nullptr) refuse(what, "it is NULL, and has " + std::to_string(count) + " elements");
  if (count - 1 > (most - size) / stride ||
      (count - 1) * stride + size >
          std::numeric_limits<std::uintptr_t>::max() - reinterpret_cast<std::uintptr_t>(first))
    refuse(what, std::to_string(count) + " elements, " + std::to_string(stride) +
                     " bytes apart, do not fit into the address space");
  return stride;
}

void require_alignment(const char* what, const void* first, std::size_t alignment) {
  if (reinterpret_cast<std::uintptr_t>(first) % alignment != 0)
    refuse(what, "its address is no multiple of " + std::to_string(alignment));
}

}  // namespace raylanes::c

const char* raylanes_last_message() {
  return raylanes::c::last_message;
}

const char* raylanes_version() {
  return raylanes::version();
}

const std::size_t* raylanes_lists_offsets(const raylanes_lists* lists) {
  return lists == nullptr ? nullptr : lists->offsets;
}

const void* raylanes_lists_items(const raylanes_lists* lists) {
  return lists == nullptr ? nullptr : lists->items;
}

void raylanes_lists_destroy(raylanes_lists* lists) {
  delete lists;
}
