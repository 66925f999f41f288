// Memory for large arrays of numbers: not cleared where no value is given, and in large pages.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace tessera {

// `bytes` > 0 of memory from the system; where there is much of it, in pages of 2 MB if the system has them,
// so that the first writes to it cost less. Throws std::bad_alloc.
void* allocateLarge(size_t bytes);
void freeLarge(void* memory) noexcept;

// For a std::vector of plain numbers: elements that are made without a value (by resize(n), say) are left as
// the memory is.
template <class T>
struct UnsetAllocator {
    static_assert(std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>);
    using value_type = T;

    UnsetAllocator() = default;
    template <class Other>
    explicit UnsetAllocator(const UnsetAllocator<Other>&) noexcept {}

    T* allocate(size_t count) {
        if (count > size_t(-1) / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(allocateLarge(count * sizeof(T)));
    }
    void deallocate(T* memory, size_t) noexcept { freeLarge(memory); }
    template <class U>
    void construct(U* at) noexcept {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }

    bool operator==(const UnsetAllocator&) const = default;
};

}  // namespace tessera
