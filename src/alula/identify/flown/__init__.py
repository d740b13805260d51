"""The equations of motion flown with the model: output error, filter error, the stall."""
