# Second half of raygate_model's build step: gathers the files that Verilator wrote into DIR for class NAME. Writes two
# translation units: slow.cpp with the code that runs once per model, if that is much, and all.cpp with all other code.
# Also writes all.d, make's rule with the files that both depend on.
file(GLOB sources RELATIVE ${DIR} ${DIR}/*.cpp)
list(REMOVE_ITEM sources all.cpp slow.cpp)  # these exist if two builds share a folder
set(slow ${sources})
list(FILTER slow INCLUDE REGEX "__Slow\\.cpp")
set(slow_bytes 0)
foreach(file ${slow})
  file(SIZE ${DIR}/${file} bytes)
  math(EXPR slow_bytes "${slow_bytes} + ${bytes}")
endforeach()
if(slow_bytes LESS 200000)  # parsing Verilator's headers for a second unit would take longer
  set(slow)
endif()
list(REMOVE_ITEM sources "" ${slow})
foreach(part sources slow)
  list(TRANSFORM ${part} REPLACE "(.+)" "#include \"\\1\"")
  list(JOIN ${part} "\n" ${part})
endforeach()
file(WRITE ${DIR}/all.cpp "${sources}\n")
file(WRITE ${DIR}/slow.cpp "${slow}\n")

# Verilator's rule has every written file as a target; the build knows only all.cpp. Names of the files that Verilator
# read are relative to the folder in which Verilator and this script run.
file(READ ${DIR}/${NAME}__ver.d depends)
string(REGEX REPLACE "^[^:]*:" "" depends "${depends}")
string(REGEX REPLACE " ([^/ \n])" " ${CMAKE_CURRENT_SOURCE_DIR}/\\1" depends "${depends}")
string(PREPEND depends "${DIR}/all.cpp:")
file(WRITE ${DIR}/all.d "${depends}")
