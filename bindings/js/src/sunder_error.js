/** A failure of the library. `code` is the name of the status, such as 'not_found'; `index` the element it speaks of, or null. */
export class SunderError extends Error {
  constructor(code, status, index, text) {
    super(text || code);
    this.name = 'SunderError';
    this.code = code;
    this.status = status;
    this.index = index;
  }
}

export const invalidArgument = (text) => new SunderError('invalid_argument', 7, null, text);

/** The error of a use after dispose(), or of a view that is not valid any more. */
export const invalidHandle = (text) => new SunderError('invalid_handle', 100, null, text);
