# The warning set and the floating-point contract of every target of ours. -Wnull-dereference is clang's alone: that
# of g++ 12 fires inside the standard library's inlined strings and vectors.
add_library(resect_flags INTERFACE)
target_compile_features(resect_flags INTERFACE cxx_std_20)
target_compile_options(resect_flags INTERFACE
    -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wold-style-cast
    -Wcast-qual -Wcast-align -Wnon-virtual-dtor -Woverloaded-virtual -Wundef -Wformat=2
    -Wimplicit-fallthrough -Wvla -Wmissing-declarations
    $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond -Wduplicated-branches -Wlogical-op -Wuseless-cast>
    $<$<CXX_COMPILER_ID:Clang>:-Wnull-dereference -Wextra-semi -Wimplicit-int-conversion>
    $<$<BOOL:${RESECT_WERROR}>:-Werror>)
if(RESECT_VERIFY)
    target_compile_definitions(resect_flags INTERFACE RESECT_VERIFY)
endif()
if(RESECT_SANITIZE)
    target_compile_options(resect_flags INTERFACE -fsanitize=${RESECT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(resect_flags INTERFACE -fsanitize=${RESECT_SANITIZE})
endif()
