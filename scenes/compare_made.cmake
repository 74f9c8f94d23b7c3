# Runs PYTHON SCRIPT MADE and fails unless MADE is byte for byte STORED.
execute_process(COMMAND ${PYTHON} -B ${SCRIPT} ${MADE} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${MADE} ${STORED}
                COMMAND_ERROR_IS_FATAL ANY)
