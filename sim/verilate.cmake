# Verilated models, and the tests that use them.
#
#   raygate_model(fp_adder_f16 TOP fp_adder PARAMETERS ExpWidth=5 FracWidth=10 [OPEN [LEVELS 6]])
#     Adds the static library `fp_adder_f16`: module TOP of hw/ (or of the calling folder, where a test joins several
#     modules under one top) with these parameters, as class Vfp_adder_f16 in "Vfp_adder_f16.h". OPEN allows writing
#     waveforms (sim/wave_model.h) of up to LEVELS levels of instances, and reading the signals that visible.vlt lists;
#     simulation is then slower. SHARED: instances share code (shared.vlt). Name a model after its module and the
#     meaning of its parameters; several programs can then use one model.
#     PATCHES <folder>: modules in this folder replace those of hw/, without lint. They are broken on purpose, or
#     supplied by a user (synth/brought.py).
#     NETLIST <file>: Yosys's netlist of TOP. Modules that the netlist lacks are taken from hw/.
#     AS <name>: the class is called V<name>, like that of model <name>; a program can then use this model instead.
#   raygate_model_file(ray_core_exact ray_core.cpp TOP ray_core ...)
#     Adds the same library, and the target ray_core_exact.so: a file of this name in build/sim/models with the model
#     and the wrapper sim/models/ray_core.cpp, which programs load at run time (model_loader.h).
#   raygate_sim_test(fp_adder_test MODELS fp_adder_f16 ... [LIBRARIES ...] [RANDOM_RESETS <filter>])
#     Builds <name>.cpp of this folder with GoogleTest and adds its cases to ctest. RANDOM_RESETS: the cases that match
#     GoogleTest's filter run again, from each of three sets of random register contents.
#
# Debian's verilate() isn't used, because it runs Verilator while CMake configures, one model after the other, and
# compiles the run-time library again for each model. Here a model is one build step. It has only two translation units,
# which lets the compiler inline across Verilator's functions.

find_program(VERILATOR_BIN NAMES verilator_bin HINTS $ENV{VERILATOR_ROOT}/bin REQUIRED)
find_path(VERILATOR_INCLUDE verilated.h
  HINTS $ENV{VERILATOR_ROOT}/include /usr/share/verilator/include REQUIRED)

# Code that all models share; waveforms are written as VCD, which needs no other library.
add_library(verilated STATIC
  ${VERILATOR_INCLUDE}/verilated.cpp
  ${VERILATOR_INCLUDE}/verilated_threads.cpp
  ${VERILATOR_INCLUDE}/verilated_vcd_c.cpp)
target_include_directories(verilated SYSTEM PUBLIC
  ${VERILATOR_INCLUDE} ${VERILATOR_INCLUDE}/vltstd)
target_link_libraries(verilated PUBLIC Threads::Threads)
# Verilator's code is compiled without warnings and sanitizers, and optimised in every kind of build.
# -fno-tree-slp-vectorize: vectorising neighbouring statements costs more than it gains here.
set(RAYGATE_VERILATED_OPTIONS -w -O3 -fno-tree-slp-vectorize -fno-sanitize=all)
target_compile_options(verilated PRIVATE ${RAYGATE_VERILATED_OPTIONS})
set_target_properties(verilated PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)

# hw/*/*.core list the files, in compilation order. Verilator runs in the root of the checkout and gets relative names,
# so that its output is the same in every checkout.
execute_process(COMMAND python3 -m synth.cores WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
  OUTPUT_VARIABLE RAYGATE_HW OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" RAYGATE_HW "${RAYGATE_HW}")
file(GLOB cores CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/hw/*/*.core)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${cores})
set(RAYGATE_HW_PACKAGES ${RAYGATE_HW})
list(FILTER RAYGATE_HW_PACKAGES INCLUDE REGEX "_pkg\\.sv$")
# Verilator finds a module by its name in these folders, and reads only the modules that a top needs.
set(RAYGATE_HW_FOLDERS ${RAYGATE_HW})
list(TRANSFORM RAYGATE_HW_FOLDERS REPLACE "/[^/]*$" "")
list(REMOVE_DUPLICATES RAYGATE_HW_FOLDERS)
list(TRANSFORM RAYGATE_HW_FOLDERS PREPEND -I)

# -Wall: every warning stops the build, including UNOPTFLAT (a loop in the logic, simulated by repetition).
# -fno-const-bit-op-tree: Verilator 5.006 folds trees of single-bit operations wrongly. A netlist of fp_divider in bfloat16
# had wrong quotients, but is right when evaluated by Yosys. Disabling this pass does not change the speed.
# --assert: a failed assertion stops the simulation. -Wno-SYNCASYNCNET: assertions read the asynchronous reset at clock edges.
# --x-assign, --x-initial: undefined values (registers before their first load, x in assignments) are 0, or random if the
# model's context asks for it (sim/model.h). Results must not depend on undefined values.
set(RAYGATE_VERILATOR_FLAGS -Wall -Wno-PINCONNECTEMPTY -Wno-SYNCASYNCNET -fno-const-bit-op-tree --assert
  --x-assign unique --x-initial unique sim/words.vlt)
set(RAYGATE_CHECKS sim/checks)  # bindings.sv binds them to the modules of hw/

function(raygate_model NAME)
  cmake_parse_arguments(PARSE_ARGV 1 MODEL "OPEN;SHARED" "TOP;PATCHES;NETLIST;AS;LEVELS" "PARAMETERS")
  if(NOT MODEL_TOP OR MODEL_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "raygate_model(${NAME}): expected TOP <module> [PARAMETERS ...] [OPEN] [SHARED], "
      "got ${ARGN}")
  endif()
  set(top_file ${RAYGATE_HW})
  list(FILTER top_file INCLUDE REGEX "/${MODEL_TOP}\\.sv$")
  if(NOT top_file)
    file(RELATIVE_PATH top_file ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${MODEL_TOP}.sv)
  endif()
  set(patches)
  set(options ${RAYGATE_VERILATED_OPTIONS})
  if(MODEL_NETLIST)  # lint is for hand-written code
    set(top_file ${MODEL_NETLIST})
    set(patches -Wno-lint -Wno-style -Wno-UNOPTFLAT +define+RAYGATE_NETLIST)
  elseif(NOT EXISTS ${CMAKE_SOURCE_DIR}/${top_file})
    message(FATAL_ERROR "raygate_model(${NAME}): no ${MODEL_TOP}.sv in hw/*/*.core or this folder")
  endif()

  if(NOT MODEL_AS)
    set(MODEL_AS ${NAME})
  endif()
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.verilated)
  # all.cpp includes all files that Verilator wrote; their names are not known before. For large models, slow.cpp has the
  # code that runs once (resets, first evaluation). This is half of the code; without optimisation it compiles fast.
  set(all ${dir}/all.cpp ${dir}/slow.cpp)
  set_source_files_properties(${dir}/slow.cpp PROPERTIES COMPILE_OPTIONS -O0)
  list(TRANSFORM MODEL_PARAMETERS PREPEND -G)
  set(open)
  if(MODEL_OPEN)
    set(open --trace sim/visible.vlt)
    if(MODEL_LEVELS)
      list(APPEND open --trace-depth ${MODEL_LEVELS})
    endif()
  endif()
  if(MODEL_SHARED)
    list(APPEND open sim/shared.vlt)
  endif()
  if(MODEL_PATCHES)
    set(patches -y ${MODEL_PATCHES} -Wno-lint -Wno-style -Wno-UNOPTFLAT)
  endif()
  set(read ${RAYGATE_HW_PACKAGES} ${RAYGATE_CHECKS}/bindings.sv sim/gather.cmake)
  list(TRANSFORM read PREPEND ${CMAKE_SOURCE_DIR}/)
  get_filename_component(top_path ${top_file} ABSOLUTE BASE_DIR ${CMAKE_SOURCE_DIR})
  add_custom_command(OUTPUT ${all} BYPRODUCTS ${dir}/V${MODEL_AS}.h
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${dir}
    COMMAND ${VERILATOR_BIN} --cc -O3 --no-timing
      ${RAYGATE_VERILATOR_FLAGS} ${patches} ${RAYGATE_HW_FOLDERS} -y ${RAYGATE_CHECKS} ${open}
      --prefix V${MODEL_AS} --Mdir ${dir} --make cmake --MMD
      --top-module ${MODEL_TOP} ${MODEL_PARAMETERS} ${RAYGATE_HW_PACKAGES}
      ${top_file} ${RAYGATE_CHECKS}/bindings.sv
    COMMAND ${CMAKE_COMMAND} -DDIR=${dir} -DNAME=V${MODEL_AS} -P sim/gather.cmake
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} DEPENDS ${top_path} ${read}
    DEPFILE ${dir}/all.d
    COMMENT "Verilating ${NAME}" VERBATIM COMMAND_EXPAND_LISTS)

  add_library(${NAME} STATIC ${all})
  target_include_directories(${NAME} SYSTEM PUBLIC ${dir})
  target_link_libraries(${NAME} PUBLIC verilated)
  target_compile_definitions(${NAME} PRIVATE VM_TRACE=$<BOOL:${MODEL_OPEN}>)
  target_compile_options(${NAME} PRIVATE ${options})
endfunction()

function(raygate_model_file NAME SOURCE)
  raygate_model(${NAME} ${ARGN})
  add_library(${NAME}.so MODULE EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/sim/models/${SOURCE})
  set_target_properties(${NAME} PROPERTIES EXCLUDE_FROM_ALL ON)
  # Symbols are hidden, because the compiler does not inline functions that another library could replace.
  set_target_properties(${NAME} ${NAME}.so PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  set_target_properties(${NAME}.so PROPERTIES PREFIX "" OUTPUT_NAME ${NAME} SUFFIX .so
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/sim/models)
  target_compile_definitions(${NAME}.so PRIVATE RAYGATE_MODEL=V${NAME} RAYGATE_MODEL_HEADER="V${NAME}.h"
    RAYGATE_MODEL_ROOT="V${NAME}___024root.h" "RAYGATE_FACTORY=extern \"C\" [[gnu::visibility(\"default\")]]")
  target_link_libraries(${NAME}.so PRIVATE ${NAME} glm::glm)
  target_link_options(${NAME}.so PRIVATE -Wl,-z,defs)
  set_property(GLOBAL APPEND PROPERTY RAYGATE_MODEL_FILES ${NAME}.so)
endfunction()

function(raygate_sim_test NAME)
  cmake_parse_arguments(PARSE_ARGV 1 TEST "" "RANDOM_RESETS" "MODELS;LIBRARIES")
  add_executable(${NAME} ${NAME}.cpp)
  target_link_libraries(${NAME} PRIVATE ${TEST_MODELS} ${TEST_LIBRARIES} raygate_driver)
  gtest_discover_tests(${NAME} DISCOVERY_TIMEOUT 60)
  if(TEST_RANDOM_RESETS)
    foreach(seed 1 2 3)
      add_test(NAME ${NAME}.random_reset_${seed}
        COMMAND ${NAME} --gtest_filter=${TEST_RANDOM_RESETS} --gtest_brief=1)
      set_tests_properties(${NAME}.random_reset_${seed} PROPERTIES
        ENVIRONMENT "RAYGATE_RANDOM_RESET=${seed};RAYGATE_STRESS=30000" PASS_REGULAR_EXPRESSION "PASSED  . [1-9]")
    endforeach()
  endif()
endfunction()
